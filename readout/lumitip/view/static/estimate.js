// The estimate: drawn on the grid in its own colour, and its numbers.

import { ESTIMATE } from "./canvas.js";
import { FIXED, POINT } from "./readings.js";

const CASING = "rgb(255 255 255 / 85%)";

/** Areas of 95 % and lines; dashed where the estimate itself doubts. */
export function drawEstimate(brush, grid, { kind, lines, bands, flags }) {
  brush.save();
  brush.beginPath();
  brush.rect(...grid.rectangle);
  brush.clip();
  brush.lineCap = "butt";
  brush.lineJoin = "round";
  brush.fillStyle = ESTIMATE;
  brush.globalAlpha = 0.3;
  for (const band of bands) {
    trace(brush, grid, band);
    brush.fill();
  }
  brush.globalAlpha = 1;
  lines.forEach((line, i) => {
    const axis = kind === "cable" && i === lines.length - 1;
    brush.setLineDash(flags.length ? [3, 5] : axis ? [9, 6] : []);
    for (const [colour, width] of [[CASING, 5], [ESTIMATE, 2.5]]) {
      brush.strokeStyle = colour;
      brush.lineWidth = width;
      trace(brush, grid, line);
      brush.stroke();
    }
  });
  brush.restore();
}

function trace(brush, grid, points) {
  brush.beginPath();
  for (const point of points) brush.lineTo(...grid.at(point));
}

/** A number with its error of 95 %. */
function withError(value, error, digits, unit) {
  if (value === null) return null;
  const size = error === null ? "" : ` ± ${FIXED(error, digits)}`;
  return FIXED(value, digits) + size + unit;
}

const lengthOf = ([value, error]) => withError(value, error, 2, " mm");
const turnOf = ([value, error]) => withError(value, error, 1, "°");

/** [name, text] of an estimate; always as many rows, so that nothing moves. */
export function estimateReadings(estimate) {
  if (!estimate) return ["offset", "angle", "", "", "misfit"].map((name) => [name, null]);
  const { kind, vertex_mm: vertex, rms_counts: rms } = estimate;
  const both = (name) => [estimate[name], estimate.error[name]];
  const rows = [["offset", lengthOf(both("offset_mm"))], ["angle", turnOf(both("angle_deg"))]];
  if (kind === "cable") rows.push(["width", lengthOf(both("width_mm"))]);
  if (kind === "corner") {
    rows.push(["opening", turnOf(both("opening_deg"))]);
    rows.push(["vertex", vertex && POINT(vertex)]);
  }
  while (rows.length < 4) rows.push(["", null]);
  return [...rows, ["misfit", rms === null ? null : `${FIXED(rms, 1)} counts`]];
}

/** The text below the numbers: the first flag in words and the names of others, and whether the
 * finger was not tared, of which no flag need be the sign. */
export function estimateWords(estimate, { estimates: { state, detail }, calibrated, player }) {
  if (state === "failed") return `no estimate: ${detail}`;
  if (state === "preparing") return "the tables of the estimate are being computed";
  const [first, ...others] = estimate?.flags ?? [];
  const also = others.length ? `; also ${others.join(", ")}` : "";
  const doubt = first ? estimate.words[0] + also : "";
  const untared = calibrated || player ? "" : "Not tared yet";
  return [doubt, untared].filter(Boolean).join(". ");
}
