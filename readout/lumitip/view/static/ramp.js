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
