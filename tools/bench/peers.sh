#!/usr/bin/env bash
# Compares rangepose with OpenCV's surface_matching (PPF and ICP) on the same simulated bins: one after the other, on the same
# cores, with the same bin boxes. Prints a Markdown table.
#   tools/bench/peers.sh [OUT]         OUT: folder for bins and results, new; default build/peers
# In the environment: BINS (default 3) and SEED (default 5200) of each set of bins, PARTS (default models/reporting/*.ply; these
# were never tuned on), NOISE (default sensor; `rangepose simulate --help`), THREADS (default: all cores), BUILD_DIR (default
# build/release).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

out=${1:-build/peers}
bins=${BINS:-3}
seed=${SEED:-5200}
noise=${NOISE:-sensor}
threads=${THREADS:-$(nproc)}
build=${BUILD_DIR:-build/release}
read -r -a parts <<< "${PARTS:-$(echo models/reporting/*.ply)}"
rangepose=$build/tools/rangepose/rangepose
ppf=$build/tools/peers/rangepose_ppf

if [[ -e $out ]]; then
  echo "tools/bench/peers.sh: $out is already there; remove it or name another folder" >&2
  exit 1
fi
{
  cmake --preset release -B "$build"
  cmake --build "$build" --target rangepose
} > /dev/null
if ! cmake --build "$build" --target rangepose_ppf_program > /dev/null 2>&1; then
  echo "tools/bench/peers.sh: rangepose_ppf cannot be built; apt-get install --no-install-recommends" \
    "libopencv-contrib-dev and try again" >&2
  exit 1
fi
mkdir -p "$out"

# row NAME SYSTEM BOP CSV: the line of all objects, and the time, as `rangepose evaluate` prints them.
row() {
  "$rangepose" evaluate --bop "$3" --csv "$4" > "$4.md"
  awk -F ' *[|] *' -v part="$1" -v by="$2" '
    / s an image on average/ { time = $0; sub(/ s an image.*/, "", time); sub(/.* /, "", time) }
    $2 == "object" && $3 == "images" && !columns { columns = NF; for (i = 2; i < NF; ++i) at[$i] = i }
    $2 == "all" && columns && !done {
      done = 1
      printf "| %s | %s | %s | %s | %s | %s | %s | %s | %s |", part, by, $at["parts"], $at["first pick [%]"],
        $at["recall [%]"], $at["recall at 2 % [%]"], $at["precision [%]"], $at["AP"], $at["median MSSD [% of diameter]"]
    }
    END { printf " %s |\n", time }' "$4.md"
}

# compare NAME MODEL... : bins of the models, both systems, two rows.
compare() {
  local name=$1 set=$out/$1
  shift
  local mixed=()
  [[ $# -gt 1 ]] && mixed=(--mixed)
  {
    "$rangepose" simulate "$@" "${mixed[@]}" -o "$set" --bins "$bins" --seed "$seed" --noise "$noise"
    "$rangepose" build --bop "$set" -o "$set.rpdb"
    "$rangepose" estimate --db "$set.rpdb" --bop "$set" --csv "$set.rangepose.csv" --all --path host --threads "$threads"
    "$ppf" --db "$set.rpdb" --bop "$set" --csv "$set.ppf.csv" --threads "$threads"
  } >> "$out/log.txt"
  row "$name" rangepose "$set" "$set.rangepose.csv"
  row "$name" "OpenCV PPF" "$set" "$set.ppf.csv"
}

echo "date:  $(date --iso-8601=seconds)"
echo "cpu:   $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
echo "cores: $threads of $(nproc), load $(cut -d' ' -f1-3 /proc/loadavg)"
echo "bins:  $bins of each part, seed $seed, noise $noise"
echo
echo "| bins of | system | parts visible >= 50 % | first pick right [%] | recall [%] | at 2 % [%] | precision [%] | AP | median error [% of diameter] | time [s an image] |"
echo "|---|---|---|---|---|---|---|---|---|---|"
for part in "${parts[@]}"; do
  compare "$(basename "${part%.*}")" "$part"
done
if [[ ${#parts[@]} -gt 1 ]]; then
  compare mixed "${parts[@]}"
fi
