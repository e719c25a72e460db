#!/usr/bin/env python3
"""Check the pages: links, files and problems that they name, commands.

check_pages.py [ROOT]              exit 1 and name every link that leads nowhere,
                                   and every file or verification problem that a
                                   page of doc/theory or doc/tutorial names and
                                   that is not there; blocks marked prm or geo
                                   there must be lines of a file beside the page
check_pages.py --commands [ROOT]   print the commands of all pages as JSON
check_pages.py --self-test         prove that what is wrong is seen

Commands stand in fenced blocks marked sh, one a line; a trailing backslash
continues a line. They begin with "sabot " or "scripts/". A comment directly
before the block, <!-- test: TEXT -->, is for the test that runs them: TEXT is
appended to the command, and the word skip leaves the block out.
"""
import json
import os
import re
import sys
import tempfile

SKIPPED = {".git", "build", "results", "node_modules"}
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`]+)`")
FENCE = re.compile(r"^\s*(```|~~~)\s*(\S*)")
FOR_TEST = re.compile(r"^<!--\s*test:\s*(.*?)\s*-->$")
# Words in code font that are files, and those that are verification problems.
FILE = re.compile(r"^[\w./+-]+\.(prm|md|py|sh|cc|h|msh|geo|png|txt)$")
FOLDER = re.compile(r"^(source|include|doc|prm|tests|scripts|verification|"
                    r"examples|benchmarks)(/[\w.-]+)*/?$")
PROBLEM = re.compile(r"^(bar|contact|cost|extreme|fem|heat|johnson|mass|material|"
                     r"plate|rigid|saint|simple|spg|thermal|tie|twisting)"
                     r"(-[a-z0-9]+)+$")
# What a run leaves in its folder.
RESULTS = {"parameters.prm", "log.txt", "section.png", "build.txt"}


def pages(root):
    for where, folders, files in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in SKIPPED)
        for name in sorted(files):
            if name.endswith(".md"):
                yield os.path.join(where, name)


def read(page):
    with open(page, encoding="utf-8") as file:
        return file.read().splitlines()


def prose(page):
    """Lines outside of fenced and indented blocks, with their numbers."""
    fence = None
    for number, line in enumerate(read(page), 1):
        match = FENCE.match(line)
        if match and fence is None:
            fence = match.group(1)
        elif match and match.group(1) == fence:
            fence = None
        elif fence is None and not line.startswith("    "):
            yield number, line


def anchors(page):
    """What GitHub makes of the headings."""
    found = set()
    for _, line in prose(page):
        if line.startswith("#"):
            text = line.lstrip("#").strip().lower()
            text = re.sub(r"[^\w\- ]", "", text.replace("`", ""))
            found.add(text.replace(" ", "-"))
    return found


def problem_names(root):
    """Names in quotes in the files of the verification problems."""
    names, folder = set(), os.path.join(root, "verification")
    if os.path.isdir(folder):
        for name in os.listdir(folder):
            if name.endswith(".cc"):
                with open(os.path.join(folder, name)) as file:
                    names.update(re.findall(r'"([a-z0-9-]+)"', file.read()))
    return names


def wrong_links(root, page):
    for number, line in prose(page):
        for target in LINK.findall(CODE.sub("", line)):
            if re.match(r"^[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            file = os.path.normpath(os.path.join(os.path.dirname(page), path)
                                    ) if path else page
            place = "%s:%d" % (os.path.relpath(page, root), number)
            if not os.path.exists(file):
                yield "%s: \"%s\" leads nowhere" % (place, target)
            elif anchor and file.endswith(".md") and \
                    anchor not in anchors(file):
                yield "%s: \"%s\": no such heading" % (place, target)


def wrong_names(root, page, problems):
    folder = os.path.dirname(page)
    for number, line in prose(page):
        for word in CODE.findall(line):
            place = "%s:%d" % (os.path.relpath(page, root), number)
            is_file = FILE.match(word) or FOLDER.match(word)
            if is_file and word not in RESULTS and "NAME" not in word and \
                    not word.startswith("results/") and not any(
                        os.path.exists(os.path.join(base, word))
                        for base in (root, folder)):
                yield "%s: there is no %s" % (place, word)
            if PROBLEM.match(word) and word not in problems:
                yield "%s: no verification problem is called %s" % (place,
                                                                    word)


def wrong_quotations(root, page):
    """Blocks marked prm or geo that no file beside the page holds."""
    folder, held = os.path.dirname(page), []
    for name in sorted(os.listdir(folder)):
        if name.endswith((".prm", ".geo")):
            held.append([line.strip() for line in
                         read(os.path.join(folder, name))])
    kind, begun, block = None, 0, []
    for number, line in enumerate(read(page), 1):
        match = FENCE.match(line)
        if match and kind is None:
            kind, begun, block = match.group(2), number, []
        elif match:
            n = len(block)
            if kind in ("prm", "geo") and not any(
                    lines[i:i + n] == block for lines in held
                    for i in range(len(lines) - n + 1)):
                yield "%s:%d: no file beside the page has these lines" % (
                    os.path.relpath(page, root), begun)
            kind = None
        else:
            block.append(line.strip())


def complaints(root):
    problems = problem_names(root)
    found = []
    for page in pages(root):
        found += wrong_links(root, page)
        kind = os.path.relpath(os.path.dirname(page), root)
        if kind in (os.path.join("doc", "theory"),
                    os.path.join("doc", "tutorial")):
            found += wrong_names(root, page, problems)
            found += wrong_quotations(root, page)
    return found


def commands(root):
    """Commands of all pages, in order."""
    found = []
    for page in pages(root):
        inside, options, last, begun = None, "", "", ""
        for number, line in enumerate(read(page), 1):
            match = FENCE.match(line)
            if match and inside is None:
                inside = match.group(2)
                note = FOR_TEST.match(last)
                options = note.group(1) if note else ""
            elif match:
                inside = None
            elif inside == "sh":
                begun += line.strip()
                if begun.endswith("\\"):
                    begun = begun[:-1]
                elif begun:
                    found.append({"page": os.path.relpath(page, root),
                                  "line": number, "command": begun,
                                  "options": "" if options == "skip"
                                  else options, "skip": options == "skip"})
                    begun = ""
            if line.strip() or match:
                last = line.strip()
    return found


def self_test():
    with tempfile.TemporaryDirectory() as root:
        os.makedirs(os.path.join(root, "doc/theory"))
        os.makedirs(os.path.join(root, "verification"))
        with open(os.path.join(root, "verification/a.cc"), "w") as file:
            file.write('{"spg-there"}')
        with open(os.path.join(root, "doc/theory/a.md"), "w") as file:
            file.write("# One heading\n[a](a.md) [b](b.md) [c](#one-heading) "
                       "[d](#another)\n`source/none.cc` `spg-gone` `spg-there`\n"
                       "<!-- test: --set x -->\n```sh\nsabot run \\\n  a.prm\n"
                       "```\n```\n[e](e.md)\n```\n```prm\nset a = 1\n```\n")
        found = complaints(root)
        listed = commands(root)
    print("\n".join(found))
    print(listed)
    good = len(found) == 5 and len(listed) == 1 and \
        listed[0]["command"] == "sabot run a.prm" and \
        listed[0]["options"] == "--set x"
    return 0 if good else 1


def main():
    arguments = sys.argv[1:]
    if "--self-test" in arguments:
        return self_test()
    named = [a for a in arguments if not a.startswith("-")]
    root = named[0] if named else os.path.dirname(
        os.path.dirname(os.path.abspath(__file__)))
    if "--commands" in arguments:
        print(json.dumps(commands(root), indent=2))
        return 0
    found = complaints(root)
    print("\n".join(found) or "all links resolve")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
