#!/usr/bin/env bash
# Makes recordings and has programs that are not Glint's read them.
#   verify_mcap.sh GLINT_MAKE_RECORDINGS WORK_FOLDER
# Exit 77: skipped, with a line that says why.
set -euo pipefail

make_recordings=$1
work=$2
here=$(cd "$(dirname "$0")" && pwd)

for program in node npm; do
  command -v "$program" > /dev/null || { echo "skipped: $program is not installed"; exit 77; }
done
mkdir -p "$work/recordings"
cp "$here"/package.json "$here"/package-lock.json "$here"/verify_mcap.mjs "$work"
cd "$work"
if ! cmp -s package-lock.json node_modules/.glint_installed; then
  npm ci --no-audit --no-fund > npm.log 2>&1 || {
    echo "skipped: the packages of package-lock.json cannot be had: $(tail -n 1 npm.log)"
    exit 77
  }
  cp package-lock.json node_modules/.glint_installed
fi
"$make_recordings" recordings
node verify_mcap.mjs recordings
