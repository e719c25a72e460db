"""Inputs of fuzz.py: mesh files of every format that is read, and mistakes in
scenes and mesh files.
"""
import base64
import re
import struct
import zlib

NUMBERS = [b"0", b"-1", b"1", b"2", b"7", b"1e300", b"-1e300", b"1e-300", b"nan",
           b"inf", b"2000000000", b"-2147483648", b"4294967296",
           b"9223372036854775807", b"18446744073709551616", b"1e", b"0x10", b"",
           b"1 m", b"300 K", b"1e9 mm", b"0.001", b"1,2", b"text"]
PIECES = [b"\x00", b"\xff", b"\xef\xbb\xbf", b"#", b"\\\n", b"end\n", b"\n",
          b",", b"=", b"*", b"$", b"subsection x\n", b"include x.prm\n", b"\r\n",
          b"\xe4", b'"', b"<", b"%n%s"]
NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")


# Meshes: a block of 2 x 2 x 2 cells in each format.

def block():
    nodes = [(i, j, k) for k in range(3) for j in range(3) for i in range(3)]
    cells = []
    for k in range(2):
        for j in range(2):
            for i in range(2):
                n = i + 3 * j + 9 * k
                cells.append([n + d for d in (0, 1, 4, 3, 9, 10, 13, 12)])
    return nodes, cells


def abaqus():
    nodes, cells = block()
    text = "*Heading\n*Part, name=P\n*Node\n"
    for n, x in enumerate(nodes, 1):
        text += "%d, %g, %g, %g\n" % (n, *x)
    text += "*Element, type=C3D8R, elset=all\n"
    for n, cell in enumerate(cells, 1001):
        text += "%d, %s\n" % (n, ", ".join(str(a + 1) for a in cell))
    text += ("*Nset, nset=low, generate\n1, 9, 1\n*Elset, elset=up, generate\n"
             "1005, 1008, 1\n*Surface, name=top\nup, S2\n"
             "*Surface, type=NODE, name=tip\nlow, 1.\n"
             "*Solid Section, elset=all, material=m\n,\n*End Part\n"
             "*Assembly, name=A\n*Instance, name=P-1, part=P\n0., 0., 1.\n"
             "0., 0., 0., 0., 0., 1., 30.\n*End Instance\n"
             "*Instance, name=P-2, part=P\n9., 0., 0.\n*End Instance\n"
             "*Nset, nset=far, instance=P-2\nlow\n*End Assembly\n"
             "*Material, name=m\n*Elastic\n1., 0.3\n*Step\n*Element Output\nS\n"
             "*End Step\n")
    return text.encode()


def gmsh(version, binary):
    nodes, cells = block()
    out = [b"$MeshFormat\n%s %d 8\n" % (version, binary)]

    def put(form, *values):
        if binary:
            out.append(struct.pack("<" + form, *values))
        else:
            out.append((" ".join("%g" % v for v in values) + "\n").encode())

    if binary:
        put("i", 1)
    out.append(b"\n$EndMeshFormat\n$PhysicalNames\n2\n2 11 \"struck face\"\n"
               b"3 1 \"plate\"\n$EndPhysicalNames\n")
    groups = [(2, 3, 5, [c[:4] for c in cells[:4]]), (3, 5, 1, cells)]
    if version == b"2.2":
        out.append(b"$Nodes\n27\n")
        for n, x in enumerate(nodes, 1):
            put("iddd", n, *x)
        out.append(b"\n$EndNodes\n$Elements\n12\n")
        number = 0
        for dim, kind, tag, some in groups:
            if binary:
                put("iii", kind, len(some), 2)
            for c in some:
                number += 1
                tags = (11 if dim == 2 else 1, tag)
                corners = [a + 1 for a in c]
                if binary:
                    put("%di" % (3 + len(c)), number, *tags, *corners)
                else:
                    put("", number, kind, 2, *tags, *corners)
    else:
        out.append(b"$Entities\n")
        put("QQQQ", 0, 0, 1, 1)
        for dim, kind, tag, some in groups:
            put("i6dQiQ", tag, 0, 0, 0, 2, 2, 2, 1, 11 if dim == 2 else 1, 0)
        out.append(b"\n$EndEntities\n$Nodes\n")
        put("QQQQ", 1, 27, 1, 27)
        put("iiiQ", 3, 1, 0, 27)
        for n in range(1, 28):
            put("Q", n)
        for x in nodes:
            put("ddd", *x)
        out.append(b"\n$EndNodes\n$Elements\n")
        put("QQQQ", 2, 12, 1, 12)
        number = 0
        for dim, kind, tag, some in groups:
            put("iiiQ", dim, tag, kind, len(some))
            for c in some:
                number += 1
                put("%dQ" % (1 + len(c)), number, *[a + 1 for a in c])
    out.append(b"\n$EndElements\n")
    return b"".join(out)


def vtk(version, binary):
    nodes, cells = block()
    out = [b"# vtk DataFile Version %s\nblock\n%s\nDATASET UNSTRUCTURED_GRID\n"
           % (version, b"BINARY" if binary else b"ASCII")]

    def put(form, values):
        out.append(struct.pack(">%d%s" % (len(values), form), *values) if binary
                   else " ".join("%g" % v for v in values).encode())
        out.append(b"\n")

    out.append(b"POINTS 27 double\n")
    put("d", [c for x in nodes for c in x])
    if version == b"5.1":
        out.append(b"CELLS 9 64\nOFFSETS vtktypeint64\n")
        put("q", range(0, 72, 8))
        out.append(b"CONNECTIVITY vtktypeint64\n")
        put("q", [a for c in cells for a in c])
    else:
        out.append(b"CELLS 8 72\n")
        put("i", [a for c in cells for a in [8] + c])
    out.append(b"CELL_TYPES 8\n")
    put("i", [12] * 8)
    out.append(b"CELL_DATA 8\nFIELD FieldData 1\nMaterialID 1 8 int\n")
    put("i", [0] * 4 + [1] * 4)
    return b"".join(out)


def vtu(mode, packed):
    nodes, cells = block()
    arrays = [("Points", "Float64", 3, "d", [c for x in nodes for c in x]),
              ("connectivity", "Int64", 1, "q", [a for c in cells for a in c]),
              ("offsets", "Int64", 1, "q", list(range(8, 72, 8))),
              ("types", "UInt8", 1, "B", [12] * 8),
              ("MaterialID", "Int32", 1, "i", [0] * 4 + [1] * 4)]
    appended, tags = b"_", {}
    for name, kind, width, form, values in arrays:
        data = struct.pack("<%d%s" % (len(values), form), *values)
        if packed:
            inner = zlib.compress(data)
            head = struct.pack("<QQQQ", 1, len(data), 0, len(inner))
        else:
            inner, head = data, struct.pack("<Q", len(data))
        tag = b'<DataArray type="%s" Name="%s" NumberOfComponents="%d" ' % (
            kind.encode(), name.encode(), width)
        if mode == "ascii":
            body = b'format="ascii">' + " ".join(map(str, values)).encode()
        elif mode == "binary":
            body = b'format="binary">' + (
                base64.b64encode(head) + base64.b64encode(inner) if packed
                else base64.b64encode(head + inner))
        else:
            body = b'format="appended" offset="%d">' % (len(appended) - 1)
            appended += head + inner
        tags[name] = tag + body + b"</DataArray>\n"
    tail = (b'<AppendedData encoding="raw">\n' + appended + b"\n</AppendedData>\n"
            if mode == "appended" else b"")
    return (b'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" '
            b'version="1.0" byte_order="LittleEndian" header_type="UInt64"%s>\n'
            b'<UnstructuredGrid>\n<Piece NumberOfPoints="27" NumberOfCells="8">\n'
            b"<CellData>\n%s</CellData>\n<Points>\n%s</Points>\n<Cells>\n"
            b"%s%s%s</Cells>\n</Piece>\n</UnstructuredGrid>\n%s</VTKFile>\n"
            % (b' compressor="vtkZLibDataCompressor"' if packed else b"",
               tags["MaterialID"], tags["Points"], tags["connectivity"],
               tags["offsets"], tags["types"], tail))


def meshes():
    made = {"abaqus.inp": abaqus()}
    for version in (b"2.2", b"4.1"):
        for binary in (0, 1):
            made["gmsh-%s-%d.msh" % (version.decode(), binary)] = gmsh(version,
                                                                      binary)
    for version in (b"3.0", b"5.1"):
        for binary in (0, 1):
            made["vtk-%s-%d.vtk" % (version.decode(), binary)] = vtk(version,
                                                                    binary)
    for mode in ("ascii", "binary", "appended"):
        for packed in (0, 1):
            if not (mode == "ascii" and packed):
                made["vtu-%s-%d.vtu" % (mode, packed)] = vtu(mode, packed)
    return made


SCENE = b"""set End time = 1 us
set List of bodies = part
subsection Materials
  subsection steel
    set Density = 7830 kg/m^3
    set Young's modulus = 206 GPa
    set Poisson's ratio = 0.3
  end
end
subsection Bodies
  subsection part
    set Geometry = file
    set Discretization = %s
    set Mesh file = %s
    set Mesh unit = 1 mm
    set Material = steel
    set Clamped faces = %s
  end
end
"""


# Mistakes.

def mutate(text, chance, declared=None):
    """With @p declared, of scenes, half of the mistakes are values that the
    entry may have: these get further than the reader."""
    meant_well = declared is not None and chance.random() < 0.6
    for _ in range(chance.choice((1, 1, 1, 2, 3, 5))):
        if meant_well:
            text = entry_set(text, chance, declared)
        else:
            text = chance.choice(MISTAKES)(text, chance)
    return text


def other_number(text, chance):
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    at = chance.choice(found)
    return text[:at.start()] + chance.choice(NUMBERS) + text[at.end():]


def other_word(text, chance):
    words = list(re.finditer(rb"\S+", text))
    if not words:
        return text
    at = chance.choice(words)
    return text[:at.start()] + chance.choice(words).group() + text[at.end():]


def lines_moved(text, chance):
    lines = text.split(b"\n")
    a, b = chance.randrange(len(lines)), chance.randrange(len(lines))
    kind = chance.randrange(4)
    if kind == 0:
        del lines[a]
    elif kind == 1:
        lines.insert(b, lines[a])
    elif kind == 2:
        lines[a], lines[b] = lines[b], lines[a]
    else:
        del lines[min(a, b):max(a, b)]
    return b"\n".join(lines)


def bytes_changed(text, chance):
    out = bytearray(text)
    for _ in range(chance.choice((1, 4, 16))):
        if out:
            out[chance.randrange(len(out))] = chance.randrange(256)
    return bytes(out)


def cut_off(text, chance):
    return text[:chance.randrange(len(text) + 1)]


def piece_put_in(text, chance):
    at = chance.randrange(len(text) + 1)
    return text[:at] + chance.choice(PIECES) + text[at:]


def number_scaled(text, chance):
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    at = chance.choice(found)
    value = float(at.group()) * chance.choice((-1, 0.5, 2, 10, 1e3, 1e-3, 1e6))
    return text[:at.start()] + (b"%g" % value) + text[at.end():]


def section_of(lines, number):
    """Names of the subsections that are open at a line of a scene."""
    path = []
    for line in lines[:number]:
        words = line.split(None, 1)
        if words[:1] == [b"subsection"] and len(words) == 2:
            path.append(words[1].strip().decode(errors="replace"))
        elif words[:1] == [b"end"] and path:
            path.pop()
    return path


def value_allowed(pattern, default, chance):
    """A text that an entry of such a pattern takes, at the ends of its range
    more often than not."""
    choices = re.match(r"\[Selection (.*?) ?\]", pattern)
    if choices:
        return chance.choice(choices.group(1).split("|"))
    words = re.findall(r"(?:^|, or )(never|none|yield|automatic|center|as at rest),",
                       pattern)
    bounds = re.search(r"from (\S+) to (\S+)|range (\S+)\.\.\.(\S+)", pattern)
    if words and chance.random() < 0.3:
        return chance.choice(words)
    if not bounds:
        return chance.choice((default, "0", "true", "false", "-x", "x = 0 mm"))
    low, high = [float(b) for b in bounds.groups() if b is not None]
    is_whole = pattern.startswith("[Integer")

    def one():
        value = chance.choice((
            low, high, 0., 1., 0.5 * (low + high), low * 1.0001, high * 0.9999,
            10. ** chance.uniform(-9., 9.), 10. ** chance.uniform(-4., 1.)))
        return "%.12g" % min(max(round(value) if is_whole else value, low), high)

    several = re.match(r"(?:\d+ to )?(\d+) values", pattern.replace("center, or ",
                                                                    ""))
    n = min(int(several.group(1)), chance.choice((3, 3, 3, 20))) if several else 1
    return ", ".join(one() for _ in range(n))


def entry_set(text, chance, declared):
    """Some entry of a subsection that the scene has, with a value that it may
    have. @p declared: what "sabot parameters --format json" says."""
    lines = text.split(b"\n")
    at = chance.randrange(len(lines))
    node = declared
    path = section_of(lines, at)
    for name in path:
        node = node.get(name, node.get("<name>", {}))
    entries = [name for name, entry in node.items()
               if "pattern_description" in entry
               and not name.startswith("List of")]
    if not entries:
        return text
    name = chance.choice(entries)
    line = b"set %s = %s" % (name.encode(), value_allowed(
        node[name]["pattern_description"], node[name]["default_value"],
        chance).encode())
    for n, other in enumerate(lines):
        if (re.match(rb"\s*set\s+%s\s*=" % re.escape(name.encode()), other)
                and section_of(lines, n) == path):
            lines[n] = line
            return b"\n".join(lines)
    lines.insert(at, line)
    return b"\n".join(lines)


MISTAKES = [other_number, other_number, number_scaled, other_word, lines_moved,
            lines_moved, bytes_changed, cut_off, piece_put_in]
