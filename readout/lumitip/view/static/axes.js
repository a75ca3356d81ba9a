// The sensor frame on the grid: origin, x and y in mm, and rulers along the left and lower edge.

import { theme } from "./canvas.js";

export const MARGIN = { left: 40, right: 46, top: 26, bottom: 26 }; // CSS pixels, for the words
const STEPS_MM = [1, 2, 5, 10, 20, 50, 100, 200];
const LEAST_STEP = 34; // CSS pixels between the numbers of a ruler
const FONT = "12px system-ui, sans-serif";
const widths = new Map(); // of words, in CSS pixels
const LINE = "rgb(128 138 153 / 90%)"; // visible on dark and on light cells

/** Multiples of a step within a range (mm); the step fits the scale (CSS pixels / mm). */
export function ticks(low, high, scale) {
  const step = STEPS_MM.find((s) => s * scale >= LEAST_STEP) ?? STEPS_MM.at(-1);
  const found = [];
  for (let i = Math.ceil(low / step); i <= Math.floor(high / step); i += 1) found.push(i * step);
  return found;
}

/** The axes through the origin, below the lines and numbers of the cells. */
export function drawAxes(brush, grid) {
  const [left, top, width, height] = grid.rectangle;
  const [x, y] = grid.at([0, 0]).map((v) => Math.round(v) + 0.5);
  brush.strokeStyle = brush.fillStyle = LINE;
  brush.lineWidth = 1;
  brush.setLineDash([]);
  brush.beginPath();
  brush.moveTo(left, y);
  brush.lineTo(left + width, y);
  brush.moveTo(x, top + height);
  brush.lineTo(x, top);
  brush.stroke();
  arrow(brush, [left + width, y], [1, 0]);
  arrow(brush, [x, top], [0, -1]);
  brush.beginPath();
  brush.arc(x, y, 4, 0, 2 * Math.PI);
  brush.stroke();
}

/** Rulers and names; returns the box of each word [text, left, top, width, height]. */
export function drawRulers(brush, grid) {
  const [left, top, width, height] = grid.rectangle;
  const [lowX, highX, lowY, highY] = grid.extent;
  const bottom = top + height;
  const words = [];
  brush.strokeStyle = brush.fillStyle = theme.soft;
  brush.lineWidth = 1;
  brush.font = FONT;
  brush.beginPath();
  for (const at of ticks(lowX, highX, grid.scale)) {
    const x = Math.round(grid.at([at, 0])[0]) + 0.5;
    brush.moveTo(x, bottom + 1);
    brush.lineTo(x, bottom + 5);
    words.push(word(brush, signed(at), x, bottom + 7, "center", "top"));
  }
  for (const at of ticks(lowY, highY, grid.scale)) {
    const y = Math.round(grid.at([0, at])[1]) + 0.5;
    brush.moveTo(left - 5, y);
    brush.lineTo(left - 1, y);
    words.push(word(brush, signed(at), left - 8, y, "right", "middle"));
  }
  brush.stroke();
  const [x, y] = grid.at([0, 0]);
  brush.fillStyle = theme.text;
  words.push(word(brush, "x mm", left + width + 11, y, "left", "middle"));
  words.push(word(brush, "y mm, to the tip", x, top - 7, "center", "bottom"));
  return words;
}

function signed(value) {
  return String(value).replace("-", "−");
}

function word(brush, text, x, y, align, baseline) {
  brush.textAlign = align;
  brush.textBaseline = baseline;
  brush.fillText(text, x, y);
  if (!widths.has(text)) widths.set(text, brush.measureText(text).width);
  const width = widths.get(text);
  const left = x - { left: 0, center: width / 2, right: width }[align];
  return [text, left, y - { top: 0, middle: 6, bottom: 12 }[baseline], width, 12];
}

function arrow(brush, [x, y], [right, down]) {
  brush.beginPath();
  brush.moveTo(x + 7 * right, y + 7 * down);
  brush.lineTo(x + 4 * down, y + 4 * right);
  brush.lineTo(x - 4 * down, y - 4 * right);
  brush.fill();
}
