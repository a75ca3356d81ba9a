// The scene of a GLB: groups of named bodies, two levels deep, in mm.
const SCENE_MM = 1000;
const SHARP_DEG = 25;

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let at = 0; at < text.length; at += 1) bytes[at] = text.charCodeAt(at);
  return bytes;
}

function glbOf(bytes) {
  const view = new DataView(bytes.buffer);
  const length = view.getUint32(12, true);
  const record = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
  return { record, binary: bytes.buffer.slice(28 + length) };
}

function numbersOf({ record, binary }, which) {
  const accessor = record.accessors[which];
  const start = record.bufferViews[accessor.bufferView].byteOffset || 0;
  return accessor.type === "VEC3"
    ? new Float32Array(binary, start, 3 * accessor.count)
    : new Uint32Array(binary, start, accessor.count);
}

function materialFrom(colour) {
  return new THREE.MeshStandardMaterial({
    color: new THREE.Color(...colour.slice(0, 3)),
    opacity: colour[3],
    transparent: colour[3] < 1,
    depthWrite: colour[3] === 1,
    roughness: 0.7,
    flatShading: true,
    side: THREE.DoubleSide,
    polygonOffset: true, // lines lie before faces, and clear bodies behind what touches them
    polygonOffsetFactor: colour[3] < 1 ? 4 : 1,
    polygonOffsetUnits: colour[3] < 1 ? 4 : 1,
  });
}

function bodyFrom(geometry, material, name) {
  const body = new THREE.Mesh(geometry, material);
  body.name = name;
  body.userData = { colour: material.color.clone(), opacity: material.opacity };
  const lines = new THREE.LineSegments(
    new THREE.EdgesGeometry(geometry, SHARP_DEG),
    new THREE.LineBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.28 }),
  );
  lines.raycast = () => {};
  body.add(lines);
  return body;
}

function bodyOf(glb, node) {
  const primitive = glb.record.meshes[node.mesh].primitives[0];
  const geometry = new THREE.BufferGeometry();
  const points = numbersOf(glb, primitive.attributes.POSITION).map((v) => SCENE_MM * v);
  geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
  geometry.setIndex(new THREE.BufferAttribute(numbersOf(glb, primitive.indices), 1));
  const colour = glb.record.materials[primitive.material].pbrMetallicRoughness.baseColorFactor;
  const body = bodyFrom(geometry, materialFrom(colour), node.name);
  body.position.fromArray((node.translation || [0, 0, 0]).map((v) => SCENE_MM * v));
  return body;
}

// Map of bodies by name, in a root object.
function sceneOf(base64) {
  const glb = glbOf(bytesOf(base64));
  const root = new THREE.Group();
  const bodies = new Map();
  for (const top of glb.record.scenes[glb.record.scene].nodes) {
    const node = glb.record.nodes[top];
    const group = new THREE.Group();
    group.name = node.name;
    const matrix = new THREE.Matrix4().fromArray(node.matrix);
    matrix.setPosition(new THREE.Vector3().setFromMatrixPosition(matrix).multiplyScalar(SCENE_MM));
    group.applyMatrix4(matrix);
    for (const child of node.children) {
      const body = bodyOf(glb, glb.record.nodes[child]);
      group.add(body);
      bodies.set(body.name, body);
    }
    root.add(group);
  }
  return { root, bodies };
}
