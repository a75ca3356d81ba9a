// The controls of the 3D view.
// A browser ends the oldest of many contexts, so there is one to ask with, not one for each view.
const webgl = (() => {
  try {
    return Boolean(document.createElement("canvas").getContext("webgl2"));
  } catch {
    return false;
  }
})();

function colours() {
  const style = getComputedStyle(document.documentElement);
  const [on, near] = ["--on", "--near"].map((name) => style.getPropertyValue(name).trim());
  return { on, near };
}

function rendererIn(box) {
  const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  box.append(renderer.domElement);
  return renderer;
}

// A browser may end the drawing of a view, and let it go on later.
function returning(viewer, note) {
  viewer.canvas.addEventListener("webglcontextlost", () => {
    byId(note).textContent = "The browser has stopped this 3D view. If it does not come back, "
      + "load the page again.";
    byId(note).hidden = false;
  });
  viewer.canvas.addEventListener("webglcontextrestored", () => {
    byId(note).hidden = true;
    viewer.draw();
  });
}

// Without a 3D view the rest of the page goes on, and says why there is none.
function attempt(start, note, without) {
  try {
    if (!webgl) throw new Error("this browser has no WebGL 2");
    start();
  } catch (error) {
    byId(note).textContent = `There is no 3D view: ${error.message}.`;
    byId(note).hidden = false;
    for (const id of without) byId(id).hidden = true;
  }
}

function startModel() {
  const box = byId("canvas");
  const scene = sceneOf(byId("scene-glb").textContent);
  const model = new Viewer(box, rendererIn(box), scene, (name) => !isRest(name));
  returning(model, "no-model");
  window.lumitip = { ...window.lumitip, model };
  const cellsOf = new Map(data.cells.flatMap((record) =>
    ["led", "detector"].map((role) => [record.parts[role], record.index])));

  const remark = () => model.cell(data.cells[follow.cell], shown.names, colours());
  follow.listeners.push(remark);
  shown.listeners.push((names) => {
    const kinds = new Set(names.filter(shown.has).map((name) => model.kindOf(name)));
    switched((kind) => kinds.has(kind), true);
    remark();
  });
  shown.has = (name) => model.bodies.has(name);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", remark);

  switches(model);
  turnable(model,
    "3D view. Arrow keys turn it, plus and minus zoom, 0 goes back. Click a cell to follow it.",
    (event) => {
      const hit = model.at(event.clientX, event.clientY, cellsOf);
      byId("hit").textContent = hit.name;
      if (hit.cell !== null) choose(hit.cell);
    });
  byId("explode").addEventListener("input", (e) => {
    model.explode(e.target.valueAsNumber / 100);
    model.fit();
  });
  const cut = () => {
    byId("cut-at").disabled = byId("cut").value === "";
    model.cut(byId("cut").value, byId("cut-at").valueAsNumber / 100);
  };
  byId("cut").addEventListener("change", () => {
    byId("cut-at").value = CUT_AT[byId("cut").value] ?? 50;
    cut();
  });
  byId("cut-at").addEventListener("input", cut);
  byId("look-fingers").addEventListener("click", () => {
    switched(isRest, false);
    switched((kind) => !isRest(kind), true);
    model.home();
  });
  byId("look-all").addEventListener("click", () => {
    switched(() => true, true);
    model.look(() => true, 0.62, 0.15);
  });
  for (const [finger, side] of [["emitter", -1], ["receiver", 1]]) {
    byId(`look-${finger}`).addEventListener("click", () => {
      byId("cut").value = ""; // one along the faces may have taken this one away
      cut();
      switched((kind) => kind.startsWith(`${finger}.`) && kind !== `${finger}.film`, true);
      switched((kind) => kind === `${finger}.film`, false);
      switched((kind) => !kind.startsWith(`${finger}.`), false);
      model.look((name) => name.startsWith(`${finger}.`), side * Math.PI / 2, 0);
    });
  }
  switched(isRest, false);
}

// Where a cut begins, %: one along the faces lies between the fingers at 50 %.
const CUT_AT = { 0: 75 };
const isRest = (kind) => !FINGERS.includes(kind.split(".")[0]);

// Kinds of bodies on or off, with their check boxes.
function switched(which, visible) {
  for (const box of all("#switches input")) {
    if (!which(box.dataset.kind) || box.checked === visible) continue;
    box.checked = visible;
    box.dispatchEvent(new Event("change"));
  }
}

function restLabel(group, part) {
  if (part === "body") return group;
  return part === "envelope" ? `${group} (outline only)` : `${group} ${part}`;
}

// A check box for each kind of body, in the order of the file.
function switches(model) {
  const groups = new Map(["emitter", "receiver", "rest"].map((title) => [title, []]));
  for (const kind of new Set([...model.bodies.keys()].map((name) => model.kindOf(name)))) {
    const [group, part] = kind.split(".");
    if (!isRest(kind)) groups.get(group).push([kind, part]);
    else groups.get("rest").push([kind, restLabel(group, part)]);
  }
  for (const [title, entries] of groups) {
    if (!entries.length) continue;
    const set = document.createElement("fieldset");
    set.append(Object.assign(document.createElement("legend"), { textContent: title }));
    for (const [kind, label] of entries) {
      const box = document.createElement("input");
      [box.type, box.checked] = ["checkbox", true];
      box.dataset.kind = kind;
      box.addEventListener("change", () => model.toggle(kind, box.checked));
      const text = document.createElement("label");
      text.append(box, label);
      set.append(text);
    }
    byId("switches").append(set);
  }
}

attempt(startModel, "no-model", ["canvas", "model-controls"]);
