"""The program under test, as all tests of whole runs start it.

The first three arguments of the command line: the program, the folder of the
sources, a folder for what the tests write.
"""
import json
import os
import shutil
import subprocess
import sys

SABOT, SOURCE, WORK = (os.path.abspath(path) for path in sys.argv[1:4])
QUICK = os.path.join(SOURCE, "prm/perforation/quick.prm")
BAR = os.path.join(SOURCE, "tests/scenes/bar.prm")
# OpenMPI refuses root unless told twice.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def sabot(*arguments, ranks=1, timeout=600, **options):
    """Run to the end; stdout has both of its streams as text."""
    command = [SABOT, *arguments]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "-np", str(ranks)] + command
    return subprocess.run(command, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True,
                          timeout=timeout, env=ENVIRONMENT, **options)


def folder(name):
    """A path below WORK where nothing is."""
    path = os.path.join(WORK, name)
    shutil.rmtree(path, ignore_errors=True)
    return path


def result(path):
    with open(os.path.join(path, "result.json")) as file:
        return json.load(file)


def descendants(pid):
    """Processes that @p pid started, and theirs."""
    try:
        with open("/proc/%d/task/%d/children" % (pid, pid)) as file:
            children = [int(child) for child in file.read().split()]
    except FileNotFoundError:  # it has ended
        return []
    return children + [d for child in children for d in descendants(child)]
