#!/usr/bin/env bash
# clang-tidy over the sources of build/release (src, tools, tests, cuda); arguments limit it to matching paths,
# e.g. tools/lint.sh src/sim. Uses the checks of .clang-tidy.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tidy=$(command -v clang-tidy-14 || command -v clang-tidy || true)
if [[ -z $tidy ]]; then
  echo "tools/lint.sh: clang-tidy is missing; apt-get install clang-tidy" >&2
  exit 1
fi
cmake --preset release > /dev/null

# Sources of the compile commands only: kernels (.cu) it does not parse.
root=$(pwd -P)
pattern="^$root/(src|tools|tests|cuda)/.*\.cpp$"
mapfile -t files < <(
  sed -n 's/^ *"file": "\(.*\)".*$/\1/p' build/release/compile_commands.json | sort -u |
    grep -E "$pattern" || true
)
if [[ $# -gt 0 ]]; then
  mapfile -t files < <(printf '%s\n' "${files[@]}" | grep -F "$(printf '%s\n' "$@")" || true)
fi
if [[ ${#files[@]} -eq 0 ]]; then
  echo "tools/lint.sh: no source matches" >&2
  exit 1
fi
printf '%s\0' "${files[@]}" |
  xargs -0 -n 1 -P 2 "$tidy" --quiet -p build/release
echo "lint: ${#files[@]} files"
