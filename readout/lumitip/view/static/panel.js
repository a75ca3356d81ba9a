// One finger on the page.

import { LINES } from "./canvas.js";
import { estimateReadings, estimateWords } from "./estimate.js";
import { Grid } from "./grid.js";
import { Player } from "./player.js";
import { History, Plot } from "./plot.js";
import { contactReadings, COUNT, fill, linkReadings, set } from "./readings.js";
import { Scene } from "./scene.js";
import { fileOf, post } from "./stream.js";
import { publishedLine, Series, Trend } from "./trend.js";

// Parts of a panel that are drawn less often than the cells (ms): faster changes are not readable.
const EVERY_MS = { drawPlot: 40, drawTrends: 100, writeNumbers: 100, writeWords: 700 };
const SILENT_S = 1; // without a frame the display is marked as old

/** Text beside the name: the most urgent message. */
function detailOf({ state, detail, warning, silent_s, drift, player }, silent) {
  if (state !== "connected") return detail;
  if (warning || player?.damage) return warning || player.damage;
  return silent ? `no frame for ${silent_s.toFixed(0)} s` : drift || "";
}

export class Panel {
  /** `layout` is an entry of /api/fingers; `say(text, isError)` shows a notice. */
  constructor(layout, say) {
    const template = document.querySelector("template#finger").content;
    this.element = template.cloneNode(true).querySelector("article");
    this.layout = layout;
    this.say = say;
    this.status = null;
    this.newest = null;
    this.estimate = null;
    this.estimates = new Series();
    this.published = new Series();
    this.pictures = 0;
    this.counted = { since: performance.now(), number: 0 };
    this.due = Object.fromEntries(Object.keys(EVERY_MS).map((part) => [part, 0]));
    this.late = new Set();
    this.find("h2").textContent = layout.device;
    this.find(".url").textContent = layout.url === layout.device ? "" : layout.url;
    this.find(".url").title = `${layout.url}, design ${layout.design}`;
    this.taring = false;
    this.held = null; // what is drawn while the display is frozen
    this.refused = ""; // the last action, if it was refused
    this.failed = ""; // the last error of a recording
    this.wanted = null; // whether to record, until a status says that it is so
    this.asked = Promise.resolve(); // the last request to start or stop
    this.find(".tare").onclick = () => this.tare();
    this.find(".record").onclick = () => this.record();
    if (layout.replayed) this.player = new Player(this);
    if (layout.scene) this.scene = new Scene(this);
    this.find(".grid").onclick = (event) => this.clicked(event);
    fill(this.find(".contact"), contactReadings({ markers: [], threshold: null, contrast: null }));
    fill(this.find(".estimate"), estimateReadings(null));
  }

  find(selector) {
    return this.element.querySelector(selector);
  }

  /** Call when the element is on the page. */
  placed(show) {
    this.show = show;
    this.grid = new Grid(this.find(".grid"), this.layout);
    this.history = new History(this.layout.x_mm.length);
    this.plot = new Plot(this.find(".plot"));
    this.trends = ["offset", "angle"].map((name) => new Trend(this.find(`canvas.${name}`), name));
    this.legend();
    new ResizeObserver(() => {
      this.grid.place();
      this.draw(true);
    }).observe(this.find(".grid"));
  }

  /** Draw the moment of this call until further notice, or again the newest. */
  freeze(whether) {
    const { newest, estimate, status, history, estimates, published } = this;
    this.held = whether ? {
      newest, estimate, status,
      history: history.copy(), estimates: estimates.copy(), published: published.copy(),
    } : null;
  }

  /** All that is drawn. */
  get drawn() {
    return this.held ?? this;
  }

  /** Store frames for the next redraw. */
  take(message) {
    this.history.take(message);
    const { values, frames, cells } = message;
    this.newest = {
      values: values.subarray((frames - 1) * cells),
      contact: message.contact,
      seq: message.seq[frames - 1],
    };
    this.fresh = true;
    const line = publishedLine(message.contact, this.estimate?.angle_deg ?? null);
    this.published.add({ t: message.t[frames - 1], ...line });
  }

  /** Store an estimate for the next redraw. */
  estimated(estimate) {
    this.estimate = estimate;
    this.estimates.add({
      t: estimate.t,
      offset: estimate.offset_mm,
      offsetError: estimate.error.offset_mm,
      angle: estimate.angle_deg,
      angleError: estimate.error.angle_deg,
    });
    this.fresh = true;
  }

  /** Draw new frames, or everything; what changes too fast to be read is drawn when it is due. */
  draw(all = false) {
    const { newest, estimate } = this.drawn;
    if (!newest) return;
    const now = performance.now();
    if (this.fresh || all) {
      this.fresh = false;
      this.grid.draw(newest.values, newest.contact, estimate, this.show);
      this.element.dataset.seq = newest.seq;
      this.late = new Set(Object.keys(EVERY_MS));
      this.count(now);
    }
    for (const part of this.late) {
      if (!all && now < this.due[part]) continue;
      this.due[part] = now + EVERY_MS[part];
      this.late.delete(part);
      this[part]();
    }
  }

  drawPlot() {
    this.plot.draw(this.drawn.history, this.grid.selected, this.show.span);
  }

  drawTrends() {
    for (const trend of this.trends) trend.draw(this.drawn, this.show.span);
  }

  /** The numbers beside the cells. */
  writeNumbers() {
    const { newest: { contact }, estimate } = this.drawn;
    set(this.find(".shape"), contact.shape);
    fill(this.find(".contact"), contactReadings(contact));
    this.find(".grid").setAttribute("aria-label", `cells, shape ${contact.shape}`);
    set(this.find(".kind"), estimate?.kind ?? "–");
    fill(this.find(".estimate"), estimateReadings(estimate));
  }

  writeWords() {
    const { estimate, status } = this.drawn;
    if (status) set(this.find(".words"), estimateWords(estimate, status));
  }

  count(now) {
    this.counted.number += 1;
    const passed = now - this.counted.since;
    if (passed < 1000) return;
    this.pictures = (1000 * this.counted.number) / passed;
    this.counted = { since: now, number: 0 };
  }

  /** Show a status of the server, twice a second. */
  update(status) {
    this.status = status;
    if (status.estimates.state === "failed") {
      this.estimate = null;
    }
    this.late.add("writeWords");
    const on = Boolean(status.recording?.on);
    if (this.wanted === on || status.recording?.error) this.wanted = null;
    const silent = status.silent_s > Math.max(SILENT_S, 3 / (status.rate_hz || 1));
    const detail = detailOf(status, silent);
    this.find(".detail").textContent = detail;
    this.find(".detail").title = detail;
    this.find(".detail").classList.toggle("bad", Boolean(status.warning));
    this.element.classList.toggle("stale", silent || status.state !== "connected");
    this.find(".dot").className = `dot ${status.state}`;
    set(this.find(".state"), silent && status.state === "connected" ? "silent" : status.state);
    this.find(".record").setAttribute("aria-pressed", on);
    fill(this.find(".link"), linkReadings(status, this.pictures));
    set(this.find(".losses"), status.losses.text);
    this.find(".losses").classList.toggle("bad", status.losses.fresh);
    this.allow();
    this.recorded(status.recording);
    this.player?.update(status.player);
    this.scene?.update(status.scene);
  }

  /** Name and length of the recording; once it is finished a link to the file. */
  recorded(recording) {
    const [text, link] = [this.find(".recorded span"), this.find(".recorded a")];
    const done = Boolean(recording && !recording.on);
    const error = recording?.error;
    const failed = error ? `${recording.file}: ${error}` : "";
    link.hidden = !done;
    this.find(".recorded").classList.toggle("bad", Boolean(failed));
    if (failed && failed !== this.failed) this.say(`${this.layout.device}: ${error}`, true);
    this.failed = failed;
    if (!recording) return;
    const frames = `${COUNT(recording.frames)} frames`;
    set(text, error || (done ? frames : `recording ${recording.file}: ${frames}`));
    if (!done) return;
    set(link, recording.file);
    link.href = fileOf(recording.file);
    link.download = recording.file;
  }

  async ask(action, body = {}) {
    try {
      const { said } = await post(`api/fingers/${this.layout.number}/${action}`, body);
      // What was refused before and is now done needs no error any more.
      if (said || this.refused === action) this.say(said ?? "");
      this.refused = "";
    } catch (error) {
      this.say(error.message, true);
      this.refused = action;
    }
  }

  async tare() {
    if (this.find(".tare").disabled || this.player) return;
    this.taring = true;
    this.allow();
    this.say(`${this.layout.device}: measuring the empty grasp, hold still`);
    await this.ask("tare", { kind: "empty" });
    this.taring = false;
    this.allow();
  }

  /** No button while this page or another one measures a reference. */
  allow() {
    const taring = this.taring || Boolean(this.status?.taring);
    for (const button of [".tare", ".record"]) this.find(button).disabled = taring;
  }

  record() {
    if (this.find(".record").disabled || this.player) return null;
    const on = !(this.wanted ?? this.status?.recording?.on);
    this.wanted = on;
    this.asked = this.asked.then(() => this.ask("record", { on })).then(() => {
      if (this.refused === "record") this.wanted = null;
    });
    return this.asked;
  }

  clicked({ offsetX, offsetY }) {
    const cell = this.grid.cellAt(offsetX, offsetY);
    if (cell >= 0) this.grid.toggle(cell);
    this.legend();
    this.draw(true);
  }

  clear() {
    this.grid.selected = [];
    this.legend();
    this.draw(true);
  }

  legend() {
    const entries = [
      ["mean of all cells", (i) => { i.style.borderColor = "var(--text)"; }],
      ["lowest to highest", (i) => {
        i.className = "band";
        i.style.background = "color-mix(in srgb, var(--soft) 30%, transparent)";
      }],
      ...this.grid.selected.map((cell, n) => [
        `cell ${cell}`, (i) => { i.style.borderColor = LINES[n]; },
      ]),
    ];
    this.find(".legend").replaceChildren(...entries.map(([text, style]) => {
      const entry = document.createElement("span");
      const sample = document.createElement("i");
      style(sample);
      entry.append(sample, text);
      return entry;
    }));
  }
}
