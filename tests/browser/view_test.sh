#!/bin/bash
# Tests the page of `deburr view` in headless Chromium:
#
#   tests/browser/view_test.sh build/release/deburr [FOLDER]      FOLDER gets pictures of the page
#
# Needs node (18 or later), npm and chromium; puppeteer-core is installed from npm into build/browser.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
program=$(readlink -f "${1:?expected the program deburr}")
pictures=${2:+$(readlink -m "$2")}
for tool in node npm chromium; do
    command -v $tool >/dev/null || { echo "view_test: expected $tool, found none" >&2; exit 2; }
done
mkdir -p "$source/build/browser"
cd "$source/build/browser"
[ -d node_modules/puppeteer-core ] || npm install --no-save --no-package-lock --no-audit --no-fund --silent puppeteer-core@24
exec timeout -k 10 600 node "$source/tests/browser/view_test.mjs" "$program" ${pictures:+"$pictures"}
