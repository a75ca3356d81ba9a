// One finger on the page.

import { LINES } from "./canvas.js";
import { Grid } from "./grid.js";
import { History, Plot } from "./plot.js";
import { contactReadings, fill, linkReadings } from "./readings.js";
import { post } from "./stream.js";

const TEXT_MS = 100; // faster changes are not readable
const PLOT_MS = 40;
const SEEK_MS = 60; // delay of requests while the slider is dragged
const SILENT_S = 1; // without a frame the display is marked as old

/** Text beside the name: the most urgent message. */
function detailOf({ state, detail, recording, silent_s, drift }, silent) {
  if (state !== "connected") return detail;
  if (silent) return `no frame for ${silent_s.toFixed(0)} s`;
  if (recording?.on) return `recording ${recording.file}: ${recording.frames} frames`;
  return recording?.error || drift || "";
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
    this.pictures = 0;
    this.counted = { since: performance.now(), number: 0 };
    this.due = { text: 0, plot: 0 };
    this.find("h2").textContent = layout.device;
    this.find(".url").textContent = layout.url === layout.device ? "" : layout.url;
    this.find(".url").title = `${layout.url}, design ${layout.design}`;
    this.find(".tare").onclick = () => this.tare();
    this.find(".record").onclick = () => this.record();
    if (layout.replayed) this.player = new Player(this);
    this.find(".grid").onclick = (event) => this.clicked(event);
    fill(this.find(".contact"), contactReadings({ markers: [], threshold: null, contrast: null }));
  }

  find(selector) {
    return this.element.querySelector(selector);
  }

  /** Call when the element is on the page. */
  placed(show) {
    this.show = show;
    this.grid = new Grid(this.find(".grid"), this.layout);
    this.history = new History(this.layout.x_mm.length);
    this.plot = new Plot(this.find(".plot"), this.history);
    this.legend();
    new ResizeObserver(() => {
      this.grid.place();
      this.draw(true);
    }).observe(this.find(".grid"));
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
  }

  /** Draw new frames, or everything. */
  draw(all = false) {
    if (!(this.fresh || all) || !this.newest) return;
    this.fresh = false;
    const now = performance.now();
    const { values, contact, seq } = this.newest;
    this.grid.draw(values, contact, this.show);
    if (all || now >= this.due.plot) {
      this.due.plot = now + PLOT_MS;
      this.plot.draw(this.grid.selected, this.show.span);
    }
    if (all || now >= this.due.text) {
      this.due.text = now + TEXT_MS;
      this.find(".shape").textContent = contact.shape;
      fill(this.find(".contact"), contactReadings(contact));
    }
    this.element.dataset.seq = seq;
    this.count(now);
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
    const on = Boolean(status.recording?.on);
    const silent = status.silent_s > Math.max(SILENT_S, 3 / (status.rate_hz || 1));
    const detail = detailOf(status, silent);
    this.find(".detail").textContent = detail;
    this.find(".detail").title = detail;
    this.element.classList.toggle("stale", silent || status.state !== "connected");
    this.find(".dot").className = `dot ${status.state}`;
    this.find(".dot").title = status.state;
    this.find(".record").setAttribute("aria-pressed", on);
    this.find(".grid").setAttribute("aria-label", `cells, shape ${this.newest?.contact.shape}`);
    fill(this.find(".link"), linkReadings(status, this.pictures));
    this.player?.update(status.player);
  }

  async ask(action, body = {}) {
    try {
      const { said } = await post(`api/fingers/${this.layout.number}/${action}`, body);
      if (said) this.say(said);
    } catch (error) {
      this.say(error.message, true);
    }
  }

  async tare() {
    const button = this.find(".tare");
    if (button.disabled || this.player) return;
    button.disabled = true;
    this.say(`${this.layout.device}: measuring the empty grasp, hold still`);
    await this.ask("tare", { kind: "empty" });
    button.disabled = false;
  }

  record() {
    if (this.player) return null;
    return this.ask("record", { on: !this.status?.recording?.on });
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

/** The controls of a replay. */
class Player {
  constructor(panel) {
    this.panel = panel;
    this.status = null;
    this.heldUntil = 0;
    panel.find(".player").hidden = false;
    panel.find(".actions").hidden = true;
    panel.find(".close").hidden = false;
    panel.find(".close").onclick = () => panel.ask("close");
    panel.find(".play").onclick = () => this.toggle();
    panel.find(".speed").onchange = ({ target }) => {
      target.blur();
      this.ask({ speed: Number(target.value) });
    };
    panel.find(".seek").oninput = ({ target }) => this.seek(Number(target.value));
  }

  ask(change) {
    return this.panel.ask("player", change);
  }

  toggle() {
    if (this.status) this.ask({ playing: !this.status.playing });
  }

  /** Move by some seconds. */
  seekBy(seconds) {
    if (this.status) this.seek(this.status.position_s + seconds);
  }

  /** Move to a time; of several quick calls the last one counts. */
  seek(seconds) {
    if (!this.status) return;
    const position_s = Math.min(Math.max(seconds, 0), this.status.length_s);
    this.show({ ...this.status, position_s });
    this.heldUntil = performance.now() + 700;
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.ask({ position_s }), SEEK_MS);
  }

  /** Show a status of the server, but not while the user moves the slider. */
  update(status) {
    if (status && performance.now() > this.heldUntil) this.show(status);
  }

  show(status) {
    this.status = status;
    const { playing, position_s, length_s, speed } = status;
    const seek = this.panel.find(".seek");
    seek.max = length_s;
    seek.value = position_s;
    this.panel.find(".position").textContent = `${clock(position_s)} / ${clock(length_s)}`;
    this.panel.find(".play").firstChild.textContent = playing ? "Pause " : "Play ";
    this.panel.find(".play").setAttribute("aria-pressed", playing);
    this.panel.find(".speed").value = String(speed);
  }
}

/** Minutes, seconds and tenths. */
function clock(seconds) {
  const tenths = Math.round(seconds * 10);
  const rest = ((tenths % 600) / 10).toFixed(1).padStart(4, "0");
  return `${Math.floor(tenths / 600)}:${rest}`;
}
