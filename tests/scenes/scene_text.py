"""Text of scenes from dictionaries, for the tests beside it."""


def section(name, entries, indent=""):
    text = "%ssubsection %s\n" % (indent, name)
    for key, value in entries.items():
        if isinstance(value, dict):
            text += section(key, value, indent + "  ")
        else:
            text += "%s  set %s = %s\n" % (indent, key, value)
    return text + indent + "end\n"
