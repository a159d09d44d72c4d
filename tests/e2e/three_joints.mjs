// Compare a table of joints.c with what three.js's glTF loader and animation mixer make of the same file.
//
//   node three_joints.mjs NODE_MODULES FILE TABLE
//
// Prints what was compared and the largest difference; exit status 1 when that is more than 0.1 mm.
import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, file, table] = process.argv.slice(2);
globalThis.self = globalThis;
const module = (path) => import(pathToFileURL(resolve(modules, path)));
const THREE = await module('three/build/three.module.js');
const { GLTFLoader } = await module('three/examples/jsm/loaders/GLTFLoader.js');

// Pictures need a browser and move nothing, so they are taken out; a buffer in the text becomes a binary chunk.
function readDocument(bytes) {
    let json, bin;
    if (bytes.toString('latin1', 0, 4) === 'glTF') {
        const length = bytes.readUInt32LE(12);
        json = JSON.parse(bytes.toString('utf8', 20, 20 + length));
        bin = bytes.subarray(28 + length);
    } else {
        json = JSON.parse(bytes.toString('utf8'));
        bin = Buffer.from(json.buffers[0].uri.split(',')[1], 'base64');
    }
    for (const key of ['images', 'textures', 'materials', 'samplers']) delete json[key];
    for (const mesh of json.meshes ?? []) for (const primitive of mesh.primitives) delete primitive.material;
    delete json.buffers[0].uri;
    return { json, bin };
}

function toBinary({ json, bin }) {
    const text = Buffer.from(JSON.stringify(json));
    const pad = (size) => (4 - (size % 4)) % 4;
    const head = Buffer.alloc(20), chunk = Buffer.alloc(8);
    const total = 28 + text.length + pad(text.length) + bin.length + pad(bin.length);
    head.write('glTF', 0, 'latin1');
    head.writeUInt32LE(2, 4);
    head.writeUInt32LE(total, 8);
    head.writeUInt32LE(text.length + pad(text.length), 12);
    head.write('JSON', 16, 'latin1');
    chunk.writeUInt32LE(bin.length + pad(bin.length), 0);
    chunk.write('BIN\0', 4, 'latin1');
    const whole = Buffer.concat([head, text, Buffer.alloc(pad(text.length), ' '), chunk, bin, Buffer.alloc(pad(bin.length))]);
    return whole.buffer.slice(whole.byteOffset, whole.byteOffset + whole.length);
}

const made = readDocument(readFileSync(file));
const gltf = await new Promise((done, failed) => new GLTFLoader().parse(toBinary(made), '', done, failed));
const byName = new Map();
const joints = new Set(made.json.skins.flatMap((skin) => skin.joints));
for (const [object, place] of gltf.parser.associations)
    if (joints.has(place?.nodes)) byName.set(made.json.nodes[place.nodes].name ?? `node_${place.nodes}`, object);

let mixer = null, start = 0, compared = 0, worst = 0, where = '';
const at = new THREE.Vector3();
for (const line of readFileSync(table, 'utf8').split('\n')) {
    if (line.startsWith('A ')) {
        const index = Number(line.slice(2)), animation = made.json.animations[index];
        start = Math.min(...animation.samplers.map((sampler) => made.json.accessors[sampler.input].min[0]));
        mixer?.stopAllAction();
        mixer = new THREE.AnimationMixer(gltf.scene);
        const action = mixer.clipAction(gltf.animations[index]);
        action.setLoop(THREE.LoopOnce);
        action.clampWhenFinished = true;
        action.play();
        where = gltf.animations[index].name;
    } else if (line.startsWith('F ')) {
        // setTime goes back to the beginning, but a finished action would stay finished.
        for (const action of mixer._actions) (action.paused = false), (action.enabled = true);
        mixer.setTime(start + Number(line.slice(2)));
        gltf.scene.updateMatrixWorld(true);
    } else if (line) {
        const [name, x, y, z] = line.split('\t');
        at.setFromMatrixPosition(byName.get(name).matrixWorld);
        const difference = at.distanceTo(new THREE.Vector3(Number(x), Number(y), Number(z)));
        if (!(difference <= worst)) (worst = difference), (where += difference > 1e-4 ? ` (${name})` : '');
        ++compared;
    }
}
console.log(`${compared} joint places compared, largest difference ${worst.toExponential(2)} m`);
if (!(compared > 0 && worst <= 1e-4)) {
    console.log(`too far apart: ${where}`);
    process.exit(1);
}
