// The pose over the last seconds: offset and angle, by the estimate and by the published method.

import { ESTIMATE, fit, theme } from "./canvas.js";
import { BOTTOM, drawTimes } from "./plot.js";

const LEFT = 36;
const TOP = 6;
const MOST = 4096; // points kept: a minute
const LEAST_S = 1 / 65; // between two points
const GAP_S = 0.5; // a longer gap interrupts a line, and so does a larger turn
const GAP_DEG = 45;
const STEPS = [0.5, 1, 2, 5, 10, 15, 30, 45, 90, 180];

/** Offset and angle of the published method's line; of a corner, of the border nearer to x. */
export function publishedLine({ shape, line, corner, cable }, beforeDeg) {
  const found = { edge: line, cable }[shape];
  if (shape === "corner" && corner) {
    const slope = (degrees) => Math.abs(Math.sin((degrees * Math.PI) / 180));
    const [one, two] = corner.directions;
    return lineThrough(corner.vertex, slope(one) <= slope(two) ? one : two, beforeDeg);
  }
  return found ? lineThrough(found.point, found.angle, beforeDeg) : null;
}

/** The line in the direction that is nearer to the one of before, as in view/pose.py. */
function lineThrough([x, y], angle, beforeDeg) {
  const near = beforeDeg ?? 0;
  const degrees = angle - 180 * Math.round((angle - near) / 180);
  const turn = (degrees * Math.PI) / 180;
  return { angle: degrees, offset: y * Math.cos(turn) - x * Math.sin(turn) };
}

/** Points over time, the newest last; time that goes back clears them. */
export class Series {
  constructor(points = []) {
    this.points = points;
  }

  /** The same, which stays as it is. */
  copy() {
    return new Series([...this.points]);
  }

  add(point) {
    const passed = point.t - (this.points.at(-1)?.t ?? -Infinity);
    if (passed >= 0 && passed < LEAST_S) return;
    if (passed < 0) this.points = [];
    this.points.push(point);
    if (this.points.length > 2 * MOST) this.points = this.points.slice(-MOST);
  }
}

/** A plot of one number of the pose: `name` is "offset" or "angle". */
export class Trend {
  constructor(canvas, name) {
    Object.assign(this, { canvas, name });
  }

  draw({ estimates: estimated, published: fitted, history: { last: now } }, span) {
    const { brush, width, height } = fit(this.canvas);
    const axes = { brush, span, now, left: LEFT, right: width - 2, top: TOP, bottom: height - BOTTOM };
    axes.x = (t) => axes.right - ((now - t) / span) * (axes.right - axes.left);
    this.axes = axes;
    brush.clearRect(0, 0, width, height);
    const estimates = this.seen(estimated, axes);
    const published = this.seen(fitted, axes);
    this.scale(axes, [...estimates, ...published]);
    drawTimes(axes, axes.right - axes.left > 400 ? 5 : 2);
    this.drawValues(axes);
    brush.save();
    brush.beginPath();
    brush.rect(axes.left, axes.top, axes.right - axes.left, axes.bottom - axes.top);
    brush.clip();
    this.drawError(axes, estimates);
    this.drawLine(axes, published, theme.text, 1.25);
    this.drawLine(axes, estimates, ESTIMATE, 2);
    brush.restore();
  }

  /** One point for each pixel of the time axis; `broken` where no line leads to it. */
  seen({ points }, axes) {
    const found = [];
    let before = null;
    let broken = true;
    for (const point of points) {
      if (point.t < axes.now - axes.span || point.t > axes.now) continue;
      const value = point[this.name];
      if (value === null || value === undefined) {
        broken = true;
        continue;
      }
      const apart = before && (point.t - before.t > GAP_S || Math.abs(point.angle - before.angle) > GAP_DEG);
      broken = broken || Boolean(apart);
      before = point;
      const x = Math.round(axes.x(point.t));
      const error = point[`${this.name}Error`] ?? 0;
      if (!broken && found.at(-1).x === x) Object.assign(found.at(-1), { value, error });
      else found.push({ x, value, error, broken });
      broken = false;
    }
    return found;
  }

  /** Choose the range: whole steps around all values and the zero, or the right angle nearest. */
  scale(axes, points) {
    const values = points.map(({ value }) => value);
    const middle = values.length ? (Math.min(...values) + Math.max(...values)) / 2 : 0;
    const zero = this.name === "angle" ? 90 * Math.round(middle / 90) : 0;
    const [low, high] = [Math.min(...values, zero - 2), Math.max(...values, zero + 2)];
    axes.step = STEPS.find((step) => (high - low) / step <= 4) ?? STEPS.at(-1);
    axes.low = Math.floor(low / axes.step) * axes.step;
    axes.high = Math.ceil(high / axes.step) * axes.step;
    axes.y = (value) => axes.bottom - ((value - axes.low) / (axes.high - axes.low)) * (axes.bottom - axes.top);
  }

  drawValues({ brush, low, high, step, y, left, right }) {
    brush.font = "11px system-ui, sans-serif";
    brush.textAlign = "right";
    brush.textBaseline = "middle";
    this.words = [];
    for (let value = low; value <= high + 1e-9; value += step) {
      const named = value === 0 || (this.name === "angle" && value % 90 === 0);
      const at = Math.round(y(value)) + 0.5;
      brush.strokeStyle = named ? theme.soft : theme.line;
      brush.fillStyle = named ? theme.text : theme.soft;
      brush.lineWidth = 1;
      brush.beginPath();
      brush.moveTo(left, at);
      brush.lineTo(right, at);
      brush.stroke();
      const text = String(Number(value.toFixed(1))).replace("-", "−");
      brush.fillText(text, left - 5, Math.min(Math.max(at, TOP + 1), y(low) - 1));
      this.words.push(text);
    }
  }

  /** The band of 95 % around the estimate. */
  drawError({ brush, y }, points) {
    brush.fillStyle = ESTIMATE;
    brush.globalAlpha = 0.22;
    points.forEach(({ x, value, error }, i) => {
      const next = points[i + 1];
      const wide = next && !next.broken ? next.x - x : 1;
      const top = y(value + error);
      brush.fillRect(x, top, wide, Math.max(y(value - error) - top, 0));
    });
    brush.globalAlpha = 1;
  }

  drawLine({ brush, y }, points, colour, width) {
    brush.strokeStyle = colour;
    brush.lineWidth = width;
    brush.lineJoin = "round";
    brush.beginPath();
    for (const { x, value, broken } of points) {
      if (broken) brush.moveTo(x, y(value));
      else brush.lineTo(x, y(value));
    }
    brush.stroke();
  }
}
