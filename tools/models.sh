#!/usr/bin/env bash
# Makes the meshes in models/ and its folders anew from their OpenSCAD sources, and checks that they are closed with their
# faces outwards. Needs openscad and python3; the meshes are in the repository, so that building and testing needs neither.
#   tools/models.sh [SOURCE...]        SOURCE: models/elbow.scad ...; default all
# openscad may cut the same surfaces into other triangles each time: a part that has .poses beside it then needs new ones.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

for program in openscad python3; do
  if ! command -v "$program" > /dev/null; then
    echo "tools/models.sh: $program is missing; apt-get install $program" >&2
    exit 1
  fi
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [[ $# -gt 0 ]]; then
  sources=("$@")
else
  sources=(models/*.scad models/fitting/*.scad models/tuning/*.scad models/reporting/*.scad)
fi
for source in "${sources[@]}"; do
  part=$(basename "$source" .scad)
  openscad -q -o "$work/$part.off" "$source"
  python3 tools/off_to_ply.py "$work/$part.off" "${source%.scad}.ply" --max-edge 12
done
