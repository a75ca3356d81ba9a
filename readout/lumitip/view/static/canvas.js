// What every canvas here needs: its size in pixels of the screen, and colours of the page.

/** Match a canvas to its size on the page; returns a brush in units of CSS pixels. */
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

/** Colours of the page, which follow light and dark. */
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
