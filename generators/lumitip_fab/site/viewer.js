// The 3D view: parts on and off, exploded, cut, and a cell or a line of a table marked.
const SPREAD_MM = 16;
const LAYERS = { interface: -2.4, backing: -1.4, board: 0, silicone: 1, film: 1.8 };
const ASIDE = { robot: -3.2, coupling: -2, flange_lower: -1, flange_board: -0.6, flange_upper: 0,
  gripper: 1.2, holder: 1.2 };
const FINGERS = ["emitter", "receiver"];
const ON_PARTS = 0.45; // of the distance from board to silicone
const SHINE = 0.3; // opacity of what others hide of a marked body
const [FEW, HUE_TURN] = [4, 0.11]; // marked bodies that have a hue each, and the step between two

function ghostOf(geometry) {
  const ghost = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({
    transparent: true, depthTest: false, depthWrite: false,
    stencilWrite: true, stencilFunc: THREE.NotEqualStencilFunc,
    stencilZPass: THREE.ReplaceStencilOp,
  }));
  ghost.raycast = () => {};
  ghost.renderOrder = 10;
  return ghost;
}

class Viewer {
  constructor(box, renderer, { root, bodies }, athome) {
    [this.box, this.renderer, this.athome] = [box, renderer, athome];
    [this.root, this.bodies, this.marked] = [root, bodies, new Set()];
    this.scene = new THREE.Scene();
    this.scene.add(root, new THREE.HemisphereLight(0xffffff, 0x8d99aa, 0.85));
    this.lamp = new THREE.DirectionalLight(0xffffff, 0.55);
    this.scene.add(this.lamp);
    this.camera = new THREE.PerspectiveCamera(30, 1, 1, 5000);
    this.camera.up.set(0, 0, 1);
    this.target = new THREE.Vector3();
    this.plane = new THREE.Plane(new THREE.Vector3(-1, 0, 0), 0);
    this.ray = new THREE.Line(
      new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ depthTest: false, transparent: true }),
    );
    this.ray.renderOrder = 11;
    this.ray.frustumCulled = false;
    this.scene.add(this.ray);
    const placed = [...root.children, ...bodies.values()];
    this.homes = new Map(placed.map((object) => [object, object.position.clone()]));
    new ResizeObserver(() => this.resize()).observe(box);
    this.explode(0);
    this.home();
  }

  get canvas() {
    return this.renderer.domElement;
  }

  kindOf(name) {
    const [group, part] = name.split(".");
    return part in LAYERS || !FINGERS.includes(group) ? name : `${group}.parts`;
  }

  explode(share) {
    for (const body of this.bodies.values()) {
      const [group, part] = body.name.split(".");
      const layer = FINGERS.includes(group) ? (LAYERS[part] ?? ON_PARTS) : 0;
      body.position.copy(this.homes.get(body));
      body.position.z += share * SPREAD_MM * layer;
    }
    for (const group of this.root.children) {
      group.position.copy(this.homes.get(group));
      if (FINGERS.includes(group.name)) group.translateZ(-share * SPREAD_MM * 2.1);
      else group.position.z += share * SPREAD_MM * (ASIDE[group.name] ?? 0);
      if (group.name === "holder") group.position.y -= share * SPREAD_MM * 2;
    }
    this.scene.updateMatrixWorld(true);
    this.draw();
  }

  // All that is visible, from where one looks.
  fit() {
    this.look(() => true, this.azimuth, this.height);
  }

  toggle(kind, visible) {
    for (const [name, body] of this.bodies) {
      if (this.kindOf(name) === kind) body.visible = visible;
    }
    this.draw();
  }

  // The half that is nearer is taken away, so that the cut is seen.
  cut(axis, share) {
    this.renderer.clippingPlanes = axis === "" ? [] : [this.plane];
    if (axis !== "") {
      const box = this.extent(() => true);
      const way = Number(axis);
      const [low, high] = [box.min.getComponent(way), box.max.getComponent(way)];
      const side = this.camera.position.getComponent(way) < this.target.getComponent(way) ? 1 : -1;
      this.plane.normal.set(0, 0, 0).setComponent(way, side);
      this.plane.constant = -side * (low + share * (high - low));
    }
    this.draw();
  }

  extent(which) {
    const box = new THREE.Box3();
    for (const [name, body] of this.bodies) {
      if (body.visible && which(name)) box.union(new THREE.Box3().setFromObject(body));
    }
    return box;
  }

  // Turn to a side, as near as all of it is seen.
  look(which, azimuth, height) {
    const box = this.extent(which);
    box.getCenter(this.target);
    this.turnTo(1, azimuth, height);
    this.camera.updateMatrixWorld();
    const half = Math.tan((this.camera.fov * Math.PI) / 360) * 0.92;
    const back = this.camera.matrixWorld.clone().setPosition(0, 0, 0).invert();
    let away = 0;
    for (let corner = 0; corner < 8; corner += 1) {
      const at = new THREE.Vector3(...["x", "y", "z"].map((axis, bit) =>
        (corner >> bit & 1 ? box.max : box.min)[axis])).sub(this.target).applyMatrix4(back);
      const wide = Math.abs(at.x) / this.camera.aspect;
      away = Math.max(away, at.z + Math.max(Math.abs(at.y), wide) / half);
    }
    this.turnTo(away, azimuth, height);
  }

  home() {
    this.look(this.athome, 0.62, 0.3);
  }

  turnTo(away, azimuth, height) {
    const tilt = Math.min(Math.max(height, -1.55), 1.55);
    [this.away, this.azimuth, this.height] = [Math.min(Math.max(away, 8), 2500), azimuth, tilt];
    const flat = Math.cos(tilt) * this.away;
    this.camera.position.set(
      flat * Math.sin(azimuth), -flat * Math.cos(azimuth), Math.sin(tilt) * this.away);
    this.camera.position.add(this.target);
    this.camera.lookAt(this.target);
    this.lamp.position.copy(this.camera.position);
    this.lamp.target.position.copy(this.target);
    this.lamp.target.updateMatrixWorld();
    this.draw();
  }

  turn(right, up) {
    this.turnTo(this.away, this.azimuth - right, this.height + up);
  }

  zoom(factor) {
    this.turnTo(this.away * factor, this.azimuth, this.height);
  }

  pan(right, up) {
    const high = 2 * this.away * Math.tan((this.camera.fov * Math.PI) / 360);
    const scale = high / this.box.clientHeight;
    const across = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 0);
    const upward = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 1);
    this.target.addScaledVector(across, -right * scale).addScaledVector(upward, up * scale);
    this.turnTo(this.away, this.azimuth, this.height);
  }

  resize() {
    const [wide, high] = [this.box.clientWidth, this.box.clientHeight];
    if (!wide || !high) return;
    this.renderer.setSize(wide, high, false);
    this.camera.aspect = wide / high;
    this.camera.updateProjectionMatrix();
    if (this.sized) this.draw();
    else this.home();
    this.sized = true;
  }

  // Bodies in a colour with their shading; what others hide of them shines through. Few bodies have
  // a hue each.
  mark(names, colour) {
    const wanted = new Set(names.filter((name) => this.bodies.has(name)));
    for (const name of this.marked) if (!wanted.has(name)) this.unmark(this.bodies.get(name));
    const turn = wanted.size > FEW ? 0 : HUE_TURN;
    [...wanted].forEach((name, at) => {
      const tint = new THREE.Color(colour).offsetHSL(turn * at, 0, 0);
      this.paint(this.bodies.get(name), tint, SHINE);
    });
    this.marked = wanted;
  }

  unmark(body) {
    const { material, userData } = body;
    material.color.copy(userData.colour);
    material.emissive.set(0x000000);
    const { opacity } = userData;
    Object.assign(material, { opacity, transparent: opacity < 1, stencilWrite: false });
    body.renderOrder = 0;
    if (userData.ghost) userData.ghost.visible = false;
  }

  // The body itself leaves its mark in the stencil, and its ghost is drawn elsewhere alone.
  paint(body, colour, shine, stencilRef = 1) {
    const { material, userData } = body;
    material.color.set(colour);
    material.emissive.set(colour).multiplyScalar(0.08);
    Object.assign(material, {
      opacity: Math.max(userData.opacity, 0.6), transparent: true, // drawn after what is clear
      stencilWrite: true, stencilRef, stencilZPass: THREE.ReplaceStencilOp,
    });
    body.renderOrder = 9;
    if (!userData.ghost) body.add(userData.ghost = ghostOf(body.geometry));
    userData.ghost.visible = true;
    userData.ghost.material.color.set(colour);
    Object.assign(userData.ghost.material, { opacity: shine, stencilRef });
  }

  // A cell: its LED, its photodetector, and the line between them.
  cell(record, extra, colours) {
    const { led, detector } = record.parts;
    this.mark([...extra, led, detector], colours.near);
    const ends = [led, detector].map((name) => this.bodies.get(name)).filter(Boolean);
    for (const body of ends) this.paint(body, colours.on, 1, 2);
    this.ends = ends;
    this.ray.material.color.set(colours.on);
    this.draw();
  }

  middleOf(body) {
    return new THREE.Box3().setFromObject(body).getCenter(new THREE.Vector3());
  }

  draw() {
    const ends = this.ends || [];
    this.ray.visible = ends.length === 2 && ends.every((body) => body.visible);
    if (this.ray.visible) this.ray.geometry.setFromPoints(ends.map((b) => this.middleOf(b)));
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = 0;
      this.renderer.render(this.scene, this.camera);
    });
  }

  // Name of the body at a place of the canvas, and the device of a cell next to it.
  at(x, y, cells) {
    const box = this.canvas.getBoundingClientRect();
    const place = new THREE.Vector2(
      (2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(place, this.camera);
    const seen = [...this.bodies.values()].filter((body) => body.visible);
    const cut = ({ point }) =>
      this.renderer.clippingPlanes.some((plane) => plane.distanceToPoint(point) < 0);
    const hit = caster.intersectObjects(seen, false).find((each) => !cut(each));
    if (!hit) return { name: "", cell: null };
    const [group] = hit.object.name.split(".");
    const own = hit.object.parent.worldToLocal(hit.point.clone());
    let [cell, least] = [null, 3];
    for (const [name, index] of cells) {
      const body = this.bodies.get(name);
      if (name.split(".")[0] !== group || !body || hit.object.name.endsWith(".backing")) continue;
      body.geometry.computeBoundingBox();
      const middle = body.geometry.boundingBox.getCenter(new THREE.Vector3()).add(body.position);
      const away = Math.hypot(middle.x - own.x, middle.y - own.y);
      if (away < least) [cell, least] = [index, away];
    }
    return { name: hit.object.name, cell };
  }
}
