// Values of the cells behind an edge, a cable or a corner that is drawn over them.
const GRASP = { kind: "edge", x: -3, y: 1.5, angle_deg: 20, diameter: 3 };
const FAR_MM = 200;
const SLIDERS = { x: "x", y: "y", angle: "angle_deg", diameter: "diameter" };

const FILLS = RAMP.map((rgb) => `rgb(${rgb.join(" ")})`);

class Grasp {
  constructor(twin) {
    this.twin = twin;
    this.scene = byId("scene");
    this.pixels = data.cells.map((_, cell) => {
      const group = document.querySelector(`#grid [data-cell="${cell}"]`);
      return { hexagon: group.querySelector("polygon"), texts: all("text", group) };
    });
    this.draw();
  }

  draw() {
    const values = this.twin.values(GRASP);
    values.forEach((value, cell) => {
      const { hexagon, texts } = this.pixels[cell];
      const whole = Math.round(value);
      hexagon.style.fill = FILLS[whole];
      texts[1].textContent = whole;
      for (const text of texts) text.style.fill = whole > 120 ? "#14181f" : "#fff";
    });
    this.values = values;
    this.drawShape();
    const { hexagon } = this.pixels[follow.cell];
    byId("ring").setAttribute("points", hexagon.getAttribute("points"));
    byId("reads").textContent =
      `Cell ${follow.cell} reads ${Math.round(values[follow.cell])} of ${FULL}.`;
  }

  // In the object's own frame: x along it, y to its left.
  drawShape() {
    const { kind, x, y, angle_deg: angle, diameter } = GRASP;
    const corners = {
      edge: [[-FAR_MM, 0], [FAR_MM, 0], [FAR_MM, -FAR_MM], [-FAR_MM, -FAR_MM]],
      cable: [[-FAR_MM, 1], [FAR_MM, 1], [FAR_MM, -1], [-FAR_MM, -1]].map(([along, side]) =>
        [along, (side * diameter) / 2]),
      corner: [[0, 0], [FAR_MM, FAR_MM], [FAR_MM, -FAR_MM]],
    }[kind];
    if (!corners) return this.scene.replaceChildren();
    const shape = document.createElementNS("http://www.w3.org/2000/svg", "polygon");
    shape.setAttribute("points", corners.map(([u, v]) => `${u},${-v}`).join(" "));
    shape.setAttribute("transform", `translate(${x} ${-y}) rotate(${-angle})`);
    return this.scene.replaceChildren(shape);
  }

  change(values) {
    Object.assign(GRASP, values);
    for (const [id, name] of Object.entries(SLIDERS)) byId(`grasp-${id}`).value = GRASP[name];
    byId("grasp-kind").value = GRASP.kind;
    byId("grasp-diameter").closest("label").hidden = GRASP.kind !== "cable";
    byId("grasp-places").hidden = GRASP.kind === "none";
    this.draw();
  }
}

function startGrasp() {
  for (const [way, limits] of Object.entries(data.extent)) {
    [byId(`grasp-${way}`).min, byId(`grasp-${way}`).max] = limits;
  }
  const grasp = new Grasp(new Twin(data.twin));
  const svg = byId("grid");
  window.lumitip = { ...window.lumitip, grasp };
  follow.listeners.push(() => grasp.draw());
  byId("grasp-kind").addEventListener("change", (e) => grasp.change({ kind: e.target.value }));
  for (const [id, name] of Object.entries(SLIDERS)) {
    const moment = id === "diameter" ? "change" : "input"; // each diameter needs its own table
    byId(`grasp-${id}`).addEventListener(moment, (event) =>
      grasp.change({ [name]: event.target.valueAsNumber }));
  }
  let held = null;
  let moved = false;
  const place = (event) => {
    const point = new DOMPoint(event.clientX, event.clientY);
    const { x, y } = point.matrixTransform(svg.getScreenCTM().inverse());
    return [x, -y];
  };
  svg.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    [held, moved] = [[...place(event), GRASP.x, GRASP.y, event.clientX, event.clientY], false];
  });
  svg.addEventListener("pointermove", (event) => {
    if (!event.buttons) held = null; // it was released outside
    if (!held || GRASP.kind === "none") return;
    const [startX, startY, shapeX, shapeY, clientX, clientY] = held;
    if (!moved && Math.hypot(event.clientX - clientX, event.clientY - clientY) < 4) return;
    if (!moved) svg.setPointerCapture(event.pointerId);
    moved = true;
    const [x, y] = place(event);
    const within = (way, v) => Math.min(Math.max(v, data.extent[way][0]), data.extent[way][1]);
    grasp.change({ x: within("x", shapeX + x - startX), y: within("y", shapeY + y - startY) });
  });
  for (const name of ["pointerup", "pointercancel"]) {
    svg.addEventListener(name, () => {
      held = null;
    });
  }
  // The end of a drag is no click on a cell.
  svg.addEventListener("click", (event) => {
    if (moved) event.stopPropagation();
    moved = false;
  });
  grasp.change({});
}

startGrasp();
