// Values over time: mean and range of all cells, and the selected cells.

import { fit, LINES, theme } from "./canvas.js";

const LEFT = 30;
export const BOTTOM = 18;
const TOP = 6;
const GAP_S = 0.5; // a longer gap interrupts the lines
const MOST_FRAMES = 16384; // 82 s at 200 Hz
const MOST_VALUES = 4_000_000;

/** The last values of one finger, in rings of fixed size. */
export class History {
  constructor(cells) {
    this.cells = cells;
    this.size = Math.max(256, Math.min(MOST_FRAMES, Math.floor(MOST_VALUES / cells)));
    this.t = new Float64Array(this.size);
    this.mean = new Float32Array(this.size);
    this.least = new Float32Array(this.size);
    this.most = new Float32Array(this.size);
    this.values = new Float32Array(this.size * cells);
    this.clear();
  }

  clear() {
    this.count = 0;
    this.last = -Infinity;
  }

  /** The same, which stays as it is. */
  copy() {
    const rings = ["t", "mean", "least", "most", "values"].map((name) => [name, this[name].slice()]);
    return Object.assign(Object.create(History.prototype), this, Object.fromEntries(rings));
  }

  /** Add the frames of a message; clear first if time goes back. */
  take({ t, values, frames }) {
    for (let i = 0; i < frames; i += 1) {
      if (t[i] < this.last) this.clear();
      this.last = t[i];
      const at = this.count % this.size;
      const row = values.subarray(i * this.cells, (i + 1) * this.cells);
      let [sum, least, most, number] = [0, Infinity, -Infinity, 0];
      for (const value of row) {
        if (Number.isNaN(value)) continue;
        sum += value;
        number += 1;
        if (value < least) least = value;
        if (value > most) most = value;
      }
      this.t[at] = t[i];
      this.mean[at] = number ? sum / number : NaN;
      this.least[at] = least;
      this.most[at] = most;
      this.values.set(row, at * this.cells);
      this.count += 1;
    }
  }

  /** Ring positions of the frames since `from` (s), oldest first. */
  *since(from) {
    const kept = Math.min(this.count, this.size);
    let low = this.count - kept;
    let high = this.count;
    while (low < high) {
      const half = (low + high) >> 1;
      if (this.t[half % this.size] < from) low = half + 1;
      else high = half;
    }
    for (let i = low; i < this.count; i += 1) yield i % this.size;
  }
}

export class Plot {
  constructor(canvas) {
    this.canvas = canvas;
  }

  draw(history, selected, span) {
    this.history = history;
    const { brush, width, height } = fit(this.canvas);
    const axes = {
      brush, span, left: LEFT, right: width - 2, top: TOP, bottom: height - BOTTOM,
      now: this.history.last,
      x(t) { return this.right - ((this.now - t) / this.span) * (this.right - this.left); },
      y(value) { return this.bottom - (value / 255) * (this.bottom - this.top); },
    };
    brush.clearRect(0, 0, width, height);
    drawAxes(axes);
    if (!this.history.count) return;
    const columns = this.columns(axes, selected);
    drawBand(axes, columns);
    drawLine(axes, columns, 0, theme.text, 1.5);
    selected.forEach((_, i) => drawLine(axes, columns, i + 1, LINES[i], 2));
  }

  /**
   * Frames by pixel of the time axis: x, range of all cells, and the mean of each line. The cost of
   * drawing does not depend on the span.
   */
  columns(axes, selected) {
    const { t, mean, least, most, values, cells } = this.history;
    const columns = [];
    let column = null;
    for (const at of this.history.since(axes.now - axes.span)) {
      const x = Math.round(axes.x(t[at]));
      if (!column || column.x !== x) {
        const broken = !column || t[at] - column.t > GAP_S;
        column = { x, broken, number: 0, least: 255, most: 0, sums: selected.map(() => 0) };
        column.sums.push(0);
        columns.push(column);
      }
      column.t = t[at];
      column.number += 1;
      column.least = Math.min(column.least, least[at]);
      column.most = Math.max(column.most, most[at]);
      column.sums[0] += mean[at];
      selected.forEach((cell, i) => {
        column.sums[i + 1] += values[at * cells + cell];
      });
    }
    return columns;
  }
}

function drawAxes(axes) {
  const { brush, left, right } = axes;
  brush.font = "11px system-ui, sans-serif";
  brush.fillStyle = theme.soft;
  brush.strokeStyle = theme.line;
  brush.lineWidth = 1;
  brush.beginPath();
  brush.textAlign = "right";
  brush.textBaseline = "middle";
  for (const value of [0, 64, 128, 192, 255]) {
    const y = Math.round(axes.y(value)) + 0.5;
    brush.moveTo(left, y);
    brush.lineTo(right, y);
    if (value % 128 === 0 || value === 255) brush.fillText(value, left - 6, y);
  }
  brush.stroke();
  drawTimes(axes, 5);
}

/** The time axis in a number of parts: lines upwards, and seconds before now below. */
export function drawTimes({ brush, left, right, top, bottom, span }, parts) {
  brush.font = "11px system-ui, sans-serif";
  brush.fillStyle = theme.soft;
  brush.strokeStyle = theme.line;
  brush.lineWidth = 1;
  brush.textBaseline = "top";
  brush.beginPath();
  const step = span / parts;
  for (let ago = 0; ago <= span; ago += step) {
    const x = Math.round(right - (ago / span) * (right - left)) - 0.5;
    brush.moveTo(x, top);
    brush.lineTo(x, bottom);
    brush.textAlign = ago === 0 ? "right" : ago === span ? "left" : "center";
    brush.fillText(ago === 0 ? "now" : `−${ago} s`, x, bottom + 5);
  }
  brush.stroke();
}

function drawBand(axes, columns) {
  const { brush } = axes;
  brush.fillStyle = theme.soft;
  brush.globalAlpha = 0.2;
  for (const [i, column] of columns.entries()) {
    const next = columns[i + 1];
    const wide = next && !next.broken ? next.x - column.x : 1;
    const top = axes.y(column.most);
    brush.fillRect(column.x, top, wide, axes.y(column.least) - top);
  }
  brush.globalAlpha = 1;
}

function drawLine(axes, columns, line, colour, width) {
  const { brush } = axes;
  brush.strokeStyle = colour;
  brush.lineWidth = width;
  brush.lineJoin = "round";
  brush.beginPath();
  for (const column of columns) {
    const y = axes.y(column.sums[line] / column.number);
    if (column.broken) brush.moveTo(column.x, y);
    else brush.lineTo(column.x, y);
  }
  brush.stroke();
}
