#!/usr/bin/env bash
# Set up, build and run a scene: scripts/run.sh [scene.prm] [sabot's options]
# Without a scene: the plate of prm/perforation/first.prm.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

scene=$root/prm/perforation/first.prm
if [ $# -gt 0 ] && [[ $1 != -* ]]; then
  scene=$(realpath "$1")
  shift
fi
"$root/scripts/packages.sh" run
"$root/scripts/build.sh" release sabot

folder=$root/results/$(basename "${scene%.prm}")
code=0
"$root/build/release/sabot" run "$scene" -o "$folder" "$@" || code=$?

# The options may have named another folder.
for ((i = 1; i < $#; ++i)); do
  case ${!i} in -o | --output) next=$((i + 1)) folder=${!next} ;; esac
done
echo
# A run that was refused (1) has left what stands there as it was.
if [ $code -ne 1 ] && [ -f "$folder/result.json" ]; then
  python3 - "$folder/result.json" <<'PY'
import json, sys
result = json.load(open(sys.argv[1]))
print("Result:  ", result["status"], result["reason"])
for name, q in result["quantities"].items():
    if q["value"] is not None:
        print("          %s = %.5g %s" % (name, q["value"], q["unit"]))
PY
  echo "Folder:   $folder"
  echo "ParaView: $folder/sabot.pvd"
fi
exit $code
