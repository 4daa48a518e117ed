#!/usr/bin/env bash
# Makes three.min.js and three.LICENSE anew, in an empty folder outside of the repository.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cp "$here/three_parts.js" "$work"
cd "$work"
npm install --silent --no-save three@0.187.0 esbuild@0.28.2
npx esbuild three_parts.js --bundle --minify --format=iife --global-name=THREE \
  --target=es2022 --legal-comments=inline --outfile=three.min.js
cp three.min.js "$here/three.min.js"
cp node_modules/three/LICENSE "$here/three.LICENSE"
