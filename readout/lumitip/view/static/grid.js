// The cells of one finger as hexagons at their positions, tip up.

import { drawAxes, drawRulers, MARGIN } from "./axes.js";
import { colourOf, fit, inkOn, LINES, theme } from "./canvas.js";
import { drawEstimate } from "./estimate.js";
import { drawContact } from "./overlay.js";

const GAP = 0.955; // size of a hexagon relative to the pitch
const SIDE = 1 / Math.sqrt(3); // of a hexagon one pitch across its flats
const LEAST_FOR_TEXT = 26; // CSS pixels of pitch

export class Grid {
  constructor(canvas, layout) {
    this.canvas = canvas;
    this.layout = layout;
    this.selected = [];
    this.place();
  }

  /** Compute the positions of the cells on the canvas, after each change of its size. */
  place() {
    const { x_mm, y_mm, pitch_mm } = this.layout;
    const { width, height } = fit(this.canvas);
    const margin = pitch_mm * 0.85;
    const [left, right] = [Math.min(...x_mm) - margin, Math.max(...x_mm) + margin];
    const [low, high] = [Math.min(...y_mm) - margin, Math.max(...y_mm) + margin];
    const across = (width - MARGIN.left - MARGIN.right) / (right - left);
    const down = (height - MARGIN.top - MARGIN.bottom) / (high - low);
    this.scale = Math.max(Math.min(across, down), 0);
    this.middle = [
      (width + MARGIN.left - MARGIN.right) / 2, (height + MARGIN.top - MARGIN.bottom) / 2,
    ];
    this.origin = [(left + right) / 2, (low + high) / 2];
    this.extent = [left, right, low, high];
    this.rectangle = [
      ...this.at([left, high]), (right - left) * this.scale, (high - low) * this.scale,
    ];
    this.reach = Math.hypot(right - left, high - low);
    this.radius = pitch_mm * this.scale * SIDE;
    this.centres = x_mm.map((x, i) => this.at([x, y_mm[i]]));
    this.hexagon = hexagon(this.radius * GAP);
  }

  /** Canvas position (CSS pixels) of a point of the sensor frame (mm); y up becomes y down. */
  at([x, y]) {
    return [
      this.middle[0] + (x - this.origin[0]) * this.scale,
      this.middle[1] - (y - this.origin[1]) * this.scale,
    ];
  }

  /** The cell under a position on the canvas, -1 if there is none. */
  cellAt(x, y) {
    let best = -1;
    let least = this.radius;
    this.centres.forEach(([cx, cy], i) => {
      const far = Math.hypot(x - cx, y - cy);
      if (far < least) [best, least] = [i, far];
    });
    return best;
  }

  /** Select or deselect a cell; at most one per colour. */
  toggle(cell) {
    if (this.selected.includes(cell)) this.selected = this.selected.filter((c) => c !== cell);
    else this.selected = [...this.selected, cell].slice(-LINES.length);
  }

  /** Cells, axes and lines; on top the numbers of the cells, which no line covers. */
  draw(values, contact, estimate, show) {
    const { brush, width, height } = fit(this.canvas);
    brush.clearRect(0, 0, width, height);
    this.centres.forEach((centre, i) => this.drawCell(brush, centre, values[i]));
    this.selected.forEach((cell, i) => this.outline(brush, this.centres[cell], LINES[i]));
    if (show.overlay) drawAxes(brush, this);
    if (show.overlay && estimate) drawEstimate(brush, this, estimate);
    if (show.overlay && contact) drawContact(brush, this, contact);
    if (show.values) this.drawValues(brush, values);
    this.words = drawRulers(brush, this);
  }

  drawCell(brush, [x, y], value) {
    brush.translate(x, y);
    if (Number.isNaN(value)) {
      brush.strokeStyle = theme.soft;
      brush.lineWidth = 1;
      brush.stroke(this.hexagon);
    } else {
      brush.fillStyle = colourOf(value);
      brush.fill(this.hexagon);
    }
    brush.translate(-x, -y);
  }

  /** The number of each cell, on a patch of its colour that interrupts lines. */
  drawValues(brush, values) {
    const pitch = this.radius / SIDE;
    if (pitch < LEAST_FOR_TEXT) return;
    const size = Math.min(15, Math.round(pitch * 0.24));
    brush.font = `${size}px system-ui, sans-serif`;
    brush.textAlign = "center";
    brush.textBaseline = "middle";
    this.centres.forEach(([x, y], i) => {
      if (Number.isNaN(values[i])) return;
      const text = String(Math.round(values[i]));
      const half = 0.32 * size * text.length + 2;
      brush.fillStyle = colourOf(values[i]);
      brush.fillRect(x - half, y - 0.6 * size, 2 * half, 1.15 * size);
      brush.fillStyle = inkOn(values[i]);
      brush.fillText(text, x, y);
    });
  }

  outline(brush, [x, y], colour) {
    brush.translate(x, y);
    brush.lineJoin = "round";
    brush.strokeStyle = theme.well;
    brush.lineWidth = 5;
    brush.stroke(this.hexagon);
    brush.strokeStyle = colour;
    brush.lineWidth = 3;
    brush.stroke(this.hexagon);
    brush.translate(-x, -y);
  }
}

/** Hexagon with corners left and right. */
function hexagon(radius) {
  const path = new Path2D();
  for (let i = 0; i < 6; i += 1) {
    const angle = (i * Math.PI) / 3;
    path.lineTo(radius * Math.cos(angle), radius * Math.sin(angle));
  }
  path.closePath();
  return path;
}
