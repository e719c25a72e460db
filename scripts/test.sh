#!/usr/bin/env bash
# Set up, build and run all tests.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$root/scripts/packages.sh" test
"$root/scripts/build.sh" release -DSABOT_WERROR=ON
# OpenMPI refuses root, as which containers run, unless told twice.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# Two at a time, but for those that hold times of runs against plans.
ctest --test-dir "$root/build/release" --output-on-failure -j 2
