// The live view: a panel for each finger, one stream, one redraw per screen refresh.

import { drawScale } from "./canvas.js";
import { Panel } from "./panel.js";
import { fileOf, get, post, Stream } from "./stream.js";

const SPANS_S = [10, 30, 60];
const NOTICE_MS = 6000;
const KEY_NAMES = { " ": "Space", 1: "1 … 9", ArrowLeft: "←", ArrowRight: "→" };

const panels = new Map();
// The last messages of each finger, for a panel that is made after they came.
const newest = { frames: new Map(), estimate: new Map() };
const show = { values: true, overlay: true, span: SPANS_S[0], frozen: false };
let chosen = 0;
let noticed = 0;
let listing = false;

const byId = (id) => document.getElementById(id);

/** Show a notice for some time; an error until the next notice or a click on it. */
function say(text, isError = false) {
  byId("notice").textContent = text;
  byId("notice").className = isError ? "error" : "";
  byId("notice").title = isError ? "click to remove" : "";
  clearTimeout(noticed);
  if (!isError) noticed = setTimeout(() => say(""), NOTICE_MS);
}

/** Show the fingers that the server has now. */
async function list() {
  if (listing) return;
  listing = true;
  try {
    const fingers = await get("api/fingers");
    // After a restart of the server the same number may be another finger.
    const shown = new Map(fingers.map((layout) => [layout.number, JSON.stringify(layout)]));
    for (const [number, panel] of panels) {
      if (shown.get(number) === JSON.stringify(panel.layout)) continue;
      panel.element.remove();
      panels.delete(number);
    }
    for (const layout of fingers) {
      if (panels.has(layout.number)) continue;
      const panel = new Panel(layout, say);
      panels.set(layout.number, panel);
      byId("fingers").append(panel.element);
      for (const event of ["pointerdown", "focusin"]) {
        panel.element.addEventListener(event, () => choose(layout.number));
      }
      panel.placed(show);
      // Of an ended replay there is one message only, which may come before the list of fingers.
      const { frames, estimate } = newest;
      if (frames.has(layout.number)) panel.take(frames.get(layout.number));
      if (estimate.has(layout.number)) panel.estimated(estimate.get(layout.number));
      if (show.frozen) panel.freeze(true);
    }
    choose(panels.has(chosen) ? chosen : fingers[0]?.number);
  } catch (error) {
    say(error.message, true);
  } finally {
    listing = false;
  }
}

function choose(number) {
  chosen = number;
  for (const [n, { element }] of panels) element.classList.toggle("chosen", n === number);
}

const stream = new Stream({
  frames: (message) => {
    newest.frames.set(message.finger, message);
    panels.get(message.finger)?.take(message);
  },
  estimate: (estimate) => {
    newest.estimate.set(estimate.finger, estimate);
    panels.get(estimate.finger)?.estimated(estimate);
  },
  status: ({ fingers }) => {
    for (const [number, status] of Object.entries(fingers)) {
      panels.get(Number(number))?.update(status);
    }
    const known = Object.keys(fingers);
    if (known.length !== panels.size || known.some((n) => !panels.has(Number(n)))) list();
  },
  open: (whether, why) => {
    document.body.dataset.stream = whether ? "open" : "closed";
    if (whether) {
      newest.frames.clear();
      newest.estimate.clear();
      say("");
      list();
    } else say(why || "no connection to lumitip view, trying again", true);
  },
});

function picture() {
  if (!show.frozen) for (const panel of panels.values()) panel.draw();
  stream.acknowledge();
  requestAnimationFrame(picture);
}
requestAnimationFrame(picture);

function redraw() {
  for (const panel of panels.values()) panel.draw(true);
}

function freeze() {
  show.frozen = !show.frozen;
  byId("freeze").setAttribute("aria-pressed", show.frozen);
  for (const panel of panels.values()) panel.freeze(show.frozen);
  redraw(); // when it freezes, all parts of the page come to the same moment
}

/** Toggle values or overlay. */
function flip(what) {
  show[what] = !show[what];
  redraw();
}

function widen() {
  show.span = SPANS_S[(SPANS_S.indexOf(show.span) + 1) % SPANS_S.length];
  redraw();
}

async function replay() {
  const names = await get("api/recordings").catch((error) => say(error.message, true));
  if (!names) return;
  const dialog = byId("recordings");
  dialog.querySelector(".none").hidden = names.length > 0;
  dialog.querySelector("ul").replaceChildren(...names.map((name) => {
    const [item, button, link] = ["li", "button", "a"].map((tag) => document.createElement(tag));
    button.textContent = name;
    Object.assign(link, { href: fileOf(name), download: name, textContent: "Download" });
    button.onclick = () => post("api/replay", { name }).then(
      ({ said, number }) => { say(said); chosen = number; list(); },
      (error) => say(error.message, true),
    );
    item.append(button, link);
    return item;
  }));
  dialog.showModal();
}

const current = () => panels.get(chosen);
const help = () => byId("keys").showModal();

/** Keyboard: one table of keys, for actions and help. */
class Keys {
  /** `table` has rows [keys, text, action]; the first key is the one shown. */
  constructor(table, list) {
    this.actions = new Map();
    for (const [keys, text, action] of table) {
      for (const key of keys) this.actions.set(key, action);
      const term = document.createElement("dt");
      const shown = document.createElement("kbd");
      shown.textContent = KEY_NAMES[keys[0]] || keys[0].toUpperCase();
      term.append(shown);
      const description = document.createElement("dd");
      description.textContent = text;
      list.append(term, description);
    }
    document.addEventListener("keydown", (event) => this.pressed(event));
    // A clicked button keeps the focus; the next space would press it again.
    document.addEventListener("click", ({ detail, target }) => {
      if (detail > 0) target.closest("button")?.blur();
    });
  }

  pressed(event) {
    const { key, target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (document.querySelector("dialog[open]")) return;
    if (target.matches("select, .scene input")) return;
    if (target.matches("button") && (key === " " || key === "Enter")) return;
    const action = this.actions.get(key.length === 1 ? key.toLowerCase() : key);
    if (!action) return;
    event.preventDefault();
    if (!event.repeat || key.startsWith("Arrow")) action(key);
  }
}

new Keys([
  [[" "], "freeze or continue the display", freeze],
  [["t"], "tare: measure the empty grasp", () => current()?.tare()],
  [["r"], "start or stop a recording", () => current()?.record()],
  [["p"], "replay a recording", replay],
  [["k"], "pause or play a replay", () => current()?.player?.toggle()],
  [["ArrowLeft"], "move a replay back by 1 s", () => current()?.player?.seekBy(-1)],
  [["ArrowRight"], "move a replay forward by 1 s", () => current()?.player?.seekBy(1)],
  [["v"], "values on the cells", () => flip("values")],
  [["o"], "axes, markers, centre, fitted lines and estimate", () => flip("overlay")],
  [["w"], "span of the time plot: 10, 30 or 60 s", widen],
  [["c"], "remove all cells from the plot", () => current()?.clear()],
  [[..."123456789"], "choose a finger", (key) => choose([...panels.keys()][key - 1] ?? chosen)],
  [["?", "h", "F1"], "this help", help],
], byId("keys").querySelector("dl"));

byId("freeze").onclick = freeze;
byId("replay").onclick = replay;
byId("help").onclick = help;
byId("notice").onclick = () => say("");
window.addEventListener("themed", redraw);
drawScale(byId("scale"));

/** For the console and the tests. */
window.lumitip = { panels, show };
