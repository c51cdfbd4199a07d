#!/usr/bin/env bash
# Makes recordings and reads them with other programs.
#   verify_mcap.sh GLINT_MAKE_RECORDINGS WORK_FOLDER
# Exit 77: skipped, with a line that states the reason.
set -euo pipefail

make_recordings=$1
work=$2
here=$(cd "$(dirname "$0")" && pwd)

"$here/install" "$work"
mkdir -p "$work/recordings"
cp "$here/verify_mcap.mjs" "$work"
cd "$work"
"$make_recordings" recordings
node verify_mcap.mjs recordings
