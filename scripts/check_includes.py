#!/usr/bin/env python3
"""Check that #include lines follow the arrows between folders.

check_includes.py ROOT        exit 1 and name every wrong line
check_includes.py --self-test prove that a wrong arrow is seen
"""
import os
import re
import sys
import tempfile

FREE = {"base", "kernels", "materials", "geometry", "bodies", "bodies/fem",
        "bodies/rigid", "bodies/spg", "couplings", "integrator", "loads", "output", "simulation",
        "study", "reference", ""}
BODY, COUPLING = "bodies/body.h", "couplings/coupling.h"
LOAD = "loads/load.h"
CONVERSION = "bodies/conversion.h"  # what bodies give and take, as BODY
# Folder: folders or single headers that it may include, besides its own.
ALLOWED = {
    "kernels": set(),
    "base": {"kernels"},
    "materials": {"base", "kernels"},
    "geometry": {"base", "kernels"},
    "geometry/shapes": {"base", "kernels", "geometry"},
    "bodies": {"base", "kernels", "materials", "geometry"},
    "bodies/fem": {"base", "kernels", "materials", "geometry", "bodies"},
    "bodies/fem/hourglass": {"base", "kernels", "materials", "bodies/fem"},
    "bodies/rigid": {"base", "kernels", "materials", "geometry", "bodies"},
    "bodies/spg": {"base", "kernels", "materials", "geometry", "bodies"},
    "couplings": {"base", "kernels", BODY, CONVERSION},
    "loads": {"base", "kernels", BODY, "geometry/face_names.h"},
    "integrator": {"base", "kernels", BODY, COUPLING, LOAD},
    "output": {"base", BODY, COUPLING},
    "simulation": FREE,
    "study": {"base", "output", "simulation"},
    "reference": {"base", "simulation", "study"},
    "charts": set(),
    "": FREE,
}
OUTSIDE_KERNELS = re.compile(r'#include\s+[<"](deal\.II|mpi|hdf5|vtk|CLI)')
INCLUDE = re.compile(r'#include\s+"sabot/(.+)"')


def room_of(folder):
    """The folder that has a rule: itself or one above, whose arrows it shares."""
    while folder not in ALLOWED and "/" in folder:
        folder = os.path.dirname(folder)
    return folder


def folder_of(path):
    return room_of(os.path.dirname(path))


def wrong_lines(root):
    wrong = []
    for top in ("include/sabot", "source"):
        for where, _, files in os.walk(os.path.join(root, top)):
            for name in sorted(files):
                if not name.endswith((".h", ".cc")):
                    continue
                file = os.path.join(where, name)
                here = os.path.relpath(where, os.path.join(root, top))
                here = room_of("" if here == "." else here)
                if here not in ALLOWED:
                    wrong.append("%s: folder %r has no rule" % (file, here))
                    continue
                for number, line in enumerate(open(file), 1):
                    place = "%s:%d" % (os.path.relpath(file, root), number)
                    if here == "kernels" and OUTSIDE_KERNELS.match(line):
                        wrong.append(place + ": kernels may only include the "
                                     "standard library and Eigen")
                    if '#include "verification/' in line:
                        wrong.append(place + ": verification is a wing that "
                                     "nothing of the program includes")
                    match = INCLUDE.match(line)
                    if not match:
                        continue
                    to = match.group(1)
                    if (folder_of(to) != here and to not in ALLOWED[here]
                            and folder_of(to) not in ALLOWED[here]):
                        wrong.append('%s: %s may not include "%s"'
                                     % (place, here or "main", to))
    return wrong


def self_test():
    with tempfile.TemporaryDirectory() as root:
        for folder, line in (("kernels", '#include "sabot/base/types.h"\n'),
                             ("bodies/fem",
                              '#include "sabot/bodies/spg/spg_body.h"\n'),
                             ("couplings",
                              '#include "sabot/bodies/body.h"\n')):
            where = os.path.join(root, "include/sabot", folder)
            os.makedirs(where)
            with open(os.path.join(where, "x.h"), "w") as file:
                file.write(line)
        found = wrong_lines(root)
    print("\n".join(found))
    return 0 if len(found) == 2 else 1


if __name__ == "__main__":
    if sys.argv[1] == "--self-test":
        sys.exit(self_test())
    found = wrong_lines(sys.argv[1])
    print("\n".join(found) or "all includes follow the arrows")
    sys.exit(1 if found else 0)
