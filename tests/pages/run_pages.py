#!/usr/bin/env python3
"""Runs every command that the pages show: run_pages.py SABOT ROOT WORKDIR

In a copy of the tree, so that the results of one command are there for the next
one of its page. Commands of scripts/ are not run: the script must exist and know
the options. What scripts/check_pages.py says of the marks in the pages holds.
Quantities that a page quotes from a run are those that the run gives.
"""
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import unittest

SABOT, ROOT, WORK = (os.path.abspath(path) for path in sys.argv[1:4])
SECONDS = 240  # of one command
QUANTITY = r"^  ([a-z ]+): ([-+.e\d]+) \S+$"  # "  depth: 0.02 m"
CHECK = os.path.join(ROOT, "scripts", "check_pages.py")
# OpenMPI refuses root unless told twice.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def copy_tree(to):
    """What commands may name; the results of earlier runs stay behind."""
    shutil.rmtree(to, ignore_errors=True)
    os.makedirs(to)
    for name in ("doc", "prm", "scripts", "tests", "examples"):
        if os.path.isdir(os.path.join(ROOT, name)):
            shutil.copytree(os.path.join(ROOT, name), os.path.join(to, name),
                            ignore=shutil.ignore_patterns("*.png", "*.pyc"))


def execute(arguments, folder):
    return subprocess.run(arguments, cwd=folder, env=ENVIRONMENT,
                          timeout=SECONDS, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True)


class Pages(unittest.TestCase):
    def test_links_resolve(self):
        done = execute([sys.executable, CHECK, ROOT], ROOT)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_wrong_links_are_seen(self):
        done = execute([sys.executable, CHECK, "--self-test"], ROOT)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_commands_run(self):
        listed = execute([sys.executable, CHECK, "--commands", ROOT], ROOT)
        commands = json.loads(listed.stdout)
        self.assertGreater(len(commands), 5)
        tree = os.path.join(WORK, "tree")
        copy_tree(tree)
        for item in commands:
            with self.subTest(page=item["page"], line=item["line"]):
                self.run_command(item, tree)

    def run_command(self, item, tree):
        words = shlex.split(item["command"], comments=True)
        self.assertTrue(words[0] == "sabot" or words[0].startswith("scripts/"),
                        item["command"])
        if words[0] != "sabot":
            self.check_script(item["command"])
        elif not item["skip"]:
            arguments = [SABOT] + words[1:] + shlex.split(item["options"])
            done = execute(arguments, tree)
            self.assertEqual(done.returncode, 0,
                             " ".join(arguments) + "\n" + done.stdout)
            if words[1] == "run" and not item["options"]:
                self.compare_quoted(item, done.stdout)

    def compare_quoted(self, item, said):
        """The text block behind the commands of a run, where there is one."""
        with open(os.path.join(ROOT, item["page"])) as file:
            behind = file.read().split("\n", item["line"])[-1]
        block = re.search(r"```text\n(.*?)```", behind.split("```sh")[0], re.S)
        for name, value in re.findall(QUANTITY, block.group(1) if block else "",
                                      re.M):
            given = dict(re.findall(QUANTITY, said, re.M))
            self.assertIn(name, given)
            # A page is taken anew when results have moved by more.
            self.assertAlmostEqual(float(value) / float(given[name]), 1.,
                                   delta=0.02, msg=name)

    def check_script(self, command):
        for part in command.split("|"):
            words = shlex.split(part, comments=True)
            path = os.path.join(ROOT, words[0])
            self.assertTrue(os.access(path, os.X_OK), words[0])
            with open(path) as file:
                text = file.read()
            if words[0] == "scripts/run.sh":  # hands the rest to sabot run
                text += execute([SABOT, "run", "--help"], ROOT).stdout
            for word in words[1:]:
                if word.startswith("-"):
                    self.assertIn(word.split("=")[0], text, command)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
