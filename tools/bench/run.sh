#!/usr/bin/env bash
# Builds the benchmarks (release) and runs them; prints the machine, then mean, median and spread of each.
#   tools/bench/run.sh [FILTER]        FILTER: regular expression on names, e.g. BM_Frame
# REPETITIONS (default 5) and BUILD_DIR (default build/release) may be set in the environment.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

filter=${1:-.}
build=${BUILD_DIR:-build/release}

cmake --preset release -B "$build" > /dev/null
cmake --build "$build" --target rangepose_bench

echo "date:  $(date --iso-8601=seconds)"
echo "cpu:   $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
echo "cores: $(nproc), load $(cut -d' ' -f1-3 /proc/loadavg)"
exec "$build/tools/bench/rangepose_bench" \
  --benchmark_filter="$filter" \
  --benchmark_repetitions="${REPETITIONS:-5}" \
  --benchmark_report_aggregates_only=true
