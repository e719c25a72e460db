#!/usr/bin/env bash
# Run the studies behind doc/validation.md and print its tables:
#   scripts/validation.sh [-o DIR] [--quick] [--paste] [STUDY...]
# STUDY: names in prm/studies; none: all. What has run already is kept, so the
# script may be stopped and started again. --quick: coarse and short, to try the
# machinery. --paste: also renew the tables of doc/validation.md and doc/figures.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$root/results/validation
quick=0
paste=0
studies=()
while [ $# -gt 0 ]; do
  case $1 in
  -o) folder=$2 && shift ;;
  --quick) quick=1 ;;
  --paste) paste=1 ;;
  *) studies+=("$1") ;;
  esac
  shift
done
if [ ${#studies[@]} -eq 0 ]; then
  studies=(copper-taylor spacing friction failure-strain zone real weldox)
fi

code=0
for study in "${studies[@]}"; do
  settings=()
  if [ $quick = 1 ]; then
    fixed="End time=10 us"
    # Spacings and cell sizes that the study itself varies stay as they are.
    case $study in
    spacing) settings=(--set "Parameters/spacing/Values=2.1 mm; 3.2 mm") ;;
    real) settings=(--set "Parameters/spacing/Values=2.1 mm; 3.2 mm") ;;
    weldox) settings=(--set "Parameters/spacing/Values=3 mm") ;;
    copper-taylor) fixed+="; Bodies/bar/Nodal spacing=1 mm" ;;
    *) fixed+="; Bodies/plate/Cell size=2.1 mm; Bodies/core/Nodal spacing=2.1 mm" ;;
    esac
    settings+=(--set "Fixed entries=$fixed")
  fi
  echo "== $study"
  # Exit code 2: a run went wrong, which the study records.
  "$root/build/release/sabot" study "$root/prm/studies/$study.prm" \
    -o "$folder/$study" --runs "$folder/runs" ${settings[@]+"${settings[@]}"} || {
    last=$?
    [ $last = 2 ] || exit $last
    code=2
  }
done
"$root/scripts/validation_tables.py" "$folder" | tee "$folder/tables.md"
if [ $paste = 1 ]; then
  "$root/scripts/paste_tables.py" "$root/doc/validation.md" <"$folder/tables.md"
  "$root/scripts/validation_tables.py" "$folder" --figures "$root/doc/figures" \
    >/dev/null
fi
exit $code
