// A printed part on the bed, as it prints, and a place on it.
const BED_STEPS = 65535;
const GRID_MM = 10;

function bedBody(part) {
  const shares = new Uint16Array(bytesOf(part.points).buffer);
  const points = Float32Array.from(shares, (share, at) =>
    part.low[at % 3] + (share / BED_STEPS) * part.size[at % 3]);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
  const triangles = new Uint32Array(bytesOf(part.triangles).buffer);
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  return bodyFrom(geometry, materialFrom([0.36, 0.43, 0.53, 1]), part.file);
}

class Bed {
  constructor(box) {
    this.box = box;
    this.viewer = null;
  }

  // The view is made when it is first seen: the page opens faster.
  start() {
    if (this.viewer) return;
    const root = new THREE.Group();
    const bodies = new Map(data.prints.map((part) => [part.file, bedBody(part)]));
    root.add(...bodies.values());
    this.viewer = new Viewer(this.box, rendererIn(this.box), { root, bodies }, () => true);
    returning(this.viewer, "no-bed");
    this.spot = new THREE.Mesh(
      new THREE.SphereGeometry(1, 24, 16),
      new THREE.MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.9 }),
    );
    this.spot.renderOrder = 12;
    this.viewer.scene.add(this.spot);
    turnable(this.viewer, "Part on the bed. Arrow keys turn it, plus and minus zoom, 0 goes back.");
    this.draw();
  }

  choose(file, place = null) {
    byId("bed-part").value = file;
    this.place = place;
    if (this.viewer) this.draw();
  }

  draw() {
    const { viewer, spot, place } = this;
    const part = data.prints.find(({ file }) => file === byId("bed-part").value);
    byId("bed-text").textContent = part.text + (place ? ` Marked: ${place.join(", ")} mm.` : "");
    for (const [file, body] of viewer.bodies) body.visible = file === part.file;
    const wide = Math.max(part.size[0], part.size[1]);
    const lines = 2 * Math.ceil(wide / 2 / GRID_MM + 1);
    viewer.scene.remove(this.grid);
    this.grid = new THREE.GridHelper(lines * GRID_MM, lines, 0x8a94a3, 0x8a94a3);
    this.grid.material.transparent = true;
    this.grid.material.opacity = 0.45;
    this.grid.rotation.x = Math.PI / 2;
    const middle = [0, 1].map((way) => part.low[way] + part.size[way] / 2);
    this.grid.position.set(middle[0], middle[1], part.low[2] - 0.05);
    viewer.scene.add(this.grid);
    spot.visible = Boolean(place);
    if (place) {
      spot.position.fromArray(place);
      spot.scale.setScalar(Math.max(...part.size) / 60);
      spot.material.color.set(colours().on);
    }
    viewer.home();
  }
}

const onBed = (start) => attempt(start, "no-bed", ["bed-panel"]);

function startBed() {
  const bed = new Bed(byId("bed"));
  window.lumitip = { ...window.lumitip, bed };
  byId("bed-part").addEventListener("change", (event) => bed.choose(event.target.value));
  shown.listeners.push((names) => {
    const name = names.find((each) => each.startsWith("print."));
    if (!name) return;
    const [file, place] = name.slice("print.".length).split("@");
    bed.choose(file, place ? place.split(",").map(Number) : null);
  });
  const seen = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    seen.disconnect();
    onBed(() => bed.start());
  }, { rootMargin: "200px" });
  seen.observe(byId("bed"));
}

onBed(startBed);
