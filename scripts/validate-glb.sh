#!/bin/sh
# Check glTF files with the Khronos validator.
#
#   scripts/validate-glb.sh FILE.glb...
#
# Prints the validator's findings and its counts for every file. Leaves with 0 when no file has an error, 1 when one has,
# and 3 when the check cannot be made here (no node, or the validator is neither installed nor to be had).
# The validator (npm's gltf-validator) is installed once into $FF_BUILD/gltf-validator (FF_BUILD: build).
# With --installed as first word it must be there already: nothing is fetched.
set -u
folder=${FF_BUILD:-build}/gltf-validator
fetch=yes
if [ "${1:-}" = --installed ]; then
    fetch=no
    shift
fi
if [ $# -eq 0 ]; then
    echo "usage: scripts/validate-glb.sh [--installed] FILE.glb..." >&2
    exit 2
fi
if ! command -v node >/dev/null; then
    echo "validate-glb.sh: node is not installed (Debian's package nodejs)" >&2
    exit 3
fi
if [ ! -d "$folder/node_modules/gltf-validator" ] && [ "$fetch" = yes ] && command -v npm >/dev/null; then
    mkdir -p "$folder"
    npm install --prefix "$folder" --no-audit --no-fund --silent gltf-validator >"$folder/npm.log" 2>&1
fi
if [ ! -d "$folder/node_modules/gltf-validator" ]; then
    echo "validate-glb.sh: the validator is not installed in $folder; with npm and internet, run scripts/validate-glb.sh once" >&2
    exit 3
fi

NODE_PATH=$folder/node_modules exec node -e '
const fs = require("fs"), validator = require("gltf-validator");
(async () => {
    let errors = 0;
    for (const file of process.argv.slice(1)) {
        const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { maxIssues: 50 });
        for (const issue of report.issues.messages)
            console.log(`${file}: ${["error", "warning", "info", "hint"][issue.severity]}: ${issue.code} at ${issue.pointer}: ${issue.message}`);
        const { numErrors, numWarnings, numInfos, numHints } = report.issues;
        console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ${numHints} hints; ${report.info.totalTriangleCount} triangles`);
        errors += numErrors;
    }
    process.exit(errors > 0 ? 1 : 0);
})().catch((failure) => { console.error(String(failure)); process.exit(1); });
' -- "$@"
