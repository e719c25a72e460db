#!/usr/bin/env python3
"""Replaces the tables of a page by those on standard input.

scripts/paste_tables.py PAGE < TABLES

They stand between the lines <!-- begin tables --> and <!-- end tables -->.
"""
import sys

BEGIN, END = "<!-- begin tables -->\n", "<!-- end tables -->\n"


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    with open(sys.argv[1]) as file:
        text = file.read()
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise SystemExit("error: \"%s\" has no place for tables" % sys.argv[1])
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    with open(sys.argv[1], "w") as file:
        file.write(before + BEGIN + "\n" + sys.stdin.read().strip() + "\n\n" +
                   END + after)


if __name__ == "__main__":
    main()
