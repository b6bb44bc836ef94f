// Prints what the Khronos validator says of a .glb file, as JSON.
//
//     NODE_PATH=target/clients/gltf/node_modules node clients/validate_glb.cjs FILE
const { readFileSync } = require('node:fs');
const { validateBytes } = require('gltf-validator');

validateBytes(new Uint8Array(readFileSync(process.argv[2])), { maxIssues: 1000 })
    .then((report) => console.log(JSON.stringify(report)))
    .catch((error) => {
        console.error(`no glTF file: ${error}`);
        process.exit(1);
    });
