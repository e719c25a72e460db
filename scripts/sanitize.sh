#!/usr/bin/env bash
# Build with AddressSanitizer and UBSan, and run the quick tests and a search by
# damaged meshes and scenes:
#   scripts/sanitize.sh [INPUTS]
# INPUTS: 10000 unless given; as many meshes inside the test program, and a tenth
# as many by "sabot check". Exit code 0: no report of a sanitizer.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
inputs=${1:-10000}
quick=(kernels base materials geometry bodies couplings output study)

"$root/scripts/build.sh" asan-ubsan sabot "${quick[@]/#/tests_}"
# OpenMPI keeps memory to the end.
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export SABOT_FUZZ_INPUTS=$inputs
names=$(IFS='|' && echo "${quick[*]}")
ctest --test-dir "$root/build/asan-ubsan" --output-on-failure -R "^($names)\$"
"$root/scripts/fuzz.py" --program "$root/build/asan-ubsan/sabot" \
  --inputs $((inputs / 10)) --runs 0.02 --timeout 120
