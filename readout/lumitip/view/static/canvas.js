// Helpers of all canvases: size in screen pixels, colours of the page, colour scale of values.

import { RAMP } from "./ramp.js";

export { RAMP };

/** Fit a canvas to its size on the page; returns its context in CSS pixels. */
export function fit(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const { width, height } = canvas.getBoundingClientRect();
  const across = Math.max(1, Math.round(width * ratio));
  const down = Math.max(1, Math.round(height * ratio));
  if (canvas.width !== across || canvas.height !== down) {
    canvas.width = across;
    canvas.height = down;
  }
  const brush = canvas.getContext("2d");
  brush.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { brush, width, height };
}

/** Colours of the page, light or dark. */
export const theme = {};

function readTheme() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["card", "well", "line", "text", "soft", "accent"]) {
    theme[name] = style.getPropertyValue(`--${name}`).trim();
  }
}

readTheme();
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  readTheme();
  window.dispatchEvent(new Event("themed"));
});

const TEXT = RAMP.map((rgb) => `rgb(${rgb})`);

/** Colour of a value. */
export function colourOf(value) {
  return TEXT[Math.min(Math.max(Math.round(value), 0), 255)];
}

/** Colour of text on a cell of this value. */
export function inkOn(value) {
  return value < 140 ? "rgb(255 255 255 / 88%)" : "rgb(12 20 36 / 85%)";
}

/** Colours of the selected cells: Okabe and Ito, for any colour vision. */
export const LINES = ["#d55e00", "#56b4e9", "#009e73", "#cc79a7", "#e69f00", "#0072b2"];

/** Colour of the estimate, apart from the white and orange of the published method. */
export const ESTIMATE = "#d81b8c";

/** Draw the scale on a canvas of 256 × 1 pixels. */
export function drawScale(canvas) {
  const brush = canvas.getContext("2d");
  RAMP.forEach((_, i) => {
    brush.fillStyle = TEXT[i];
    brush.fillRect(i, 0, 1, 1);
  });
}
