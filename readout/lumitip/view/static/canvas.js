// Helpers of all canvases: size in screen pixels, colours of the page, colour scale of values.

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

// Colour scale from dark blue to light yellow, readable with any colour vision: a straight line in
// Oklab (Ottosson 2020), so that equal steps look equal, also in a grey print.
const DARK = [0.25, -0.015, -0.09];
const LIGHT = [0.93, -0.035, 0.13];

/** sRGB bytes of an Oklab colour. */
function srgb([l, a, b]) {
  const long = (l + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const middle = (l - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const short = (l - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear = [
    4.0767416621 * long - 3.3077115913 * middle + 0.2309699292 * short,
    -1.2684380046 * long + 2.6097574011 * middle - 0.3413193965 * short,
    -0.0041960863 * long - 0.7034186147 * middle + 1.707614701 * short,
  ];
  return linear.map((c) => {
    const cut = Math.min(Math.max(c, 0), 1);
    const coded = cut <= 0.0031308 ? 12.92 * cut : 1.055 * cut ** (1 / 2.4) - 0.055;
    return Math.round(255 * coded);
  });
}

/** sRGB bytes of the values 0 to 255. */
export const RAMP = Array.from({ length: 256 }, (_, i) =>
  srgb(DARK.map((dark, k) => dark + (LIGHT[k] - dark) * (i / 255))),
);
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
