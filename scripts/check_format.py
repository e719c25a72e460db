#!/usr/bin/env python3
"""Check that the C++ files are as .clang-format wants them; exit 1 if not.

scripts/check_format.py [--fix]    in the project's root
"""
import pathlib
import subprocess
import sys

FOLDERS = ("source", "include", "verification", "tests", "benchmarks",
           "examples")


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    files = sorted(str(p) for folder in FOLDERS
                   for p in (root / folder).rglob("*")
                   if p.suffix in (".cc", ".cpp", ".h"))
    how = ["-i"] if sys.argv[1:] == ["--fix"] else ["--dry-run", "-Werror"]
    return subprocess.run(["clang-format"] + how + files).returncode


if __name__ == "__main__":
    sys.exit(main())
