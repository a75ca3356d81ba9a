"use strict";
// One cell in all panels. Panels need no code of their own: what belongs to a cell says so.
const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const all = (selector, root = document) => [...root.querySelectorAll(selector)];
const follow = { cell: 0, listeners: [] };

function index(attribute) {
  const found = new Map();
  for (const element of all(`[${attribute}]`)) {
    const name = element.getAttribute(attribute);
    found.set(name, [...(found.get(name) || []), element]);
  }
  return found;
}
const cells = index("data-cell");
const nets = index("data-net");
const parts = index("data-part");
const wires = index("data-wire");
const panelOf = (element) => element.closest("figure, .panel");

function choose(cell, pushed = true) {
  follow.cell = cell;
  const record = data.cells[cell];
  for (const element of all(".on, .own, .shared, .role")) {
    element.classList.remove("on", "own", "shared", "role");
    if (element.hasAttribute("aria-pressed")) element.setAttribute("aria-pressed", "false");
  }
  for (const element of cells.get(String(cell))) {
    element.classList.add("on");
    element.setAttribute("aria-pressed", "true");
    rove(element);
  }
  const mark = (names, map, kind) =>
    names.forEach((name) => (map.get(name) || []).forEach((e) => e.classList.add(kind)));
  mark(record.shared, nets, "shared");
  mark(record.nets, nets, "own");
  mark(Object.values(record.parts), parts, "role");
  mark(record.wires, wires, "on");
  byId("record-h").textContent = `Cell ${cell}`;
  byId("rows").replaceChildren(...record.rows.flatMap(([name, text]) => [
    Object.assign(document.createElement("dt"), { textContent: name }),
    Object.assign(document.createElement("dd"), { textContent: text }),
  ]));
  byId("faults").textContent = record.faults.join("; ");
  byId("number").value = cell;
  for (const listener of follow.listeners) listener(cell);
  if (!pushed) return;
  try {
    history.replaceState(null, "", `#cell-${cell}`);
  } catch {
    // Safari refuses more than 100 in 30 s; the address then has the cell before.
  }
}

// A panel has one stop of the tabulator key; arrows go from cell to cell.
function rove(element) {
  for (const other of all(".cell", panelOf(element))) other.setAttribute("tabindex", "-1");
  element.setAttribute("tabindex", "0");
}

const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

function middle(element) {
  const box = element.getBoundingClientRect();
  return [box.x + box.width / 2, box.y + box.height / 2];
}

function beside(element, [right, down]) {
  const [x, y] = middle(element);
  let nearest = null;
  let least = Infinity;
  for (const other of all(".cell", panelOf(element))) {
    const [dx, dy] = [middle(other)[0] - x, middle(other)[1] - y];
    const along = dx * right + dy * down;
    const aside = Math.abs(dx * down) + Math.abs(dy * right);
    const away = Math.hypot(along, aside);
    if (along > 1 && aside <= 1.2 * along && away < least) [nearest, least] = [other, away];
  }
  return nearest;
}

document.addEventListener("click", (event) => {
  const cell = event.target.closest("[data-cell]") || event.target.closest("[data-follow]");
  if (cell) choose(Number(cell.dataset.cell ?? cell.dataset.follow));
});
document.addEventListener("keydown", (event) => {
  const cell = event.target.closest?.(".cell");
  if (!cell) return;
  if (WAYS[event.key]) {
    const next = beside(cell, WAYS[event.key]);
    if (next) {
      choose(Number(next.dataset.cell));
      next.focus();
    }
  } else if ((event.key === "Enter" || event.key === " ") && cell.tagName !== "BUTTON") {
    choose(Number(cell.dataset.cell));
  } else return;
  event.preventDefault();
});

const last = data.cells.length - 1;
const within = (cell) => Math.min(Math.max(Math.round(cell), 0), last);
byId("number").addEventListener("change", ({ target: { valueAsNumber: typed } }) =>
  choose(Number.isNaN(typed) ? follow.cell : within(typed)));
byId("before").addEventListener("click", () => choose(follow.cell ? follow.cell - 1 : last));
byId("after").addEventListener("click", () => choose(follow.cell < last ? follow.cell + 1 : 0));

function fromHash() {
  const found = location.hash.match(/^#cell-(\d+)$/);
  if (!found || Number(found[1]) > last) return false;
  choose(Number(found[1]), false);
  return true;
}
window.addEventListener("hashchange", () => fromHash() && byId("cells").scrollIntoView());

for (const element of all("svg .cell")) {
  element.setAttribute("role", "button");
  element.setAttribute("aria-pressed", "false");
  element.setAttribute("tabindex", "-1");
}
for (const element of all("button.cell")) element.setAttribute("tabindex", "-1");
