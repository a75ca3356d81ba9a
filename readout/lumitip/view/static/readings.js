// The numbers beside the cells.

export const FIXED = (v, digits) => v.toFixed(digits).replace("-", "−");
const DEGREES = (v) => `${FIXED(v, 1)}°`;
const MILLIMETRES = (v) => `${FIXED(v, 2)} mm`;
export const POINT = ([x, y]) => `${FIXED(x, 1)}, ${FIXED(y, 1)} mm`;
export const COUNT = (v) => v.toLocaleString("en").replaceAll(",", "\u202f");

/** [name, text] of a contact; `null`: does not apply. */
export function contactReadings(contact) {
  const { centre, threshold, contrast, markers } = contact;
  const { line, corner, cable } = contact;
  const shown = { edge: line, corner, cable }[contact.shape];
  return [
    ["centre", centre && POINT(centre)],
    ...{
      corner: () => [
        ["opening", corner && DEGREES(corner.opening)],
        ["vertex", corner && POINT(corner.vertex)],
      ],
      cable: () => [
        ["angle", cable && DEGREES(cable.angle)],
        ["width", cable && MILLIMETRES(cable.width)],
      ],
    }[contact.shape]?.() || [["angle", line && DEGREES(line.angle)], ["", null]],
    ["fit rms", shown && MILLIMETRES(shown.rms)],
    ["threshold", threshold === null ? null : threshold.toFixed(1)],
    ["contrast", contrast === null ? null : contrast.toFixed(1)],
    ["markers", contrast === null ? null : String(markers.length / 2)],
  ];
}

/** [name, text, whether it is bad] of the link and this page. */
export function linkReadings(status, pictures) {
  const { dropped, age_ms: age } = status;
  const lost = (cause) => (dropped ? COUNT(dropped[cause]) : "not known");
  const causes = ["link", "crc", "length"].map((cause) => [
    `lost: ${cause}`, lost(cause), dropped && dropped[cause] > 0,
  ]);
  return [
    ["rate", status.rate_hz === null ? null : `${status.rate_hz.toFixed(1)} Hz`],
    ["jitter", status.jitter_ms === null ? null : `${status.jitter_ms.toFixed(2)} ms`],
    ["received", COUNT(status.received)],
    ...causes,
    ["lost: queue", COUNT(status.overflowed), status.overflowed > 0],
    ["reconnects", COUNT(status.reconnects), status.reconnects > 0],
    ["age p50", age && `${age[0].toFixed(0)} ms`],
    ["age p99", age && `${age[1].toFixed(0)} ms`, age && age[1] > 200],
    ["pictures", pictures && `${pictures.toFixed(0)} / s`],
    ["skipped here", COUNT(status.skipped)],
  ];
}

/** Fill a description list, keeping its rows. */
export function fill(list, rows) {
  while (list.children.length > 2 * rows.length) list.lastChild.remove();
  while (list.children.length < 2 * rows.length) {
    list.append(document.createElement(list.children.length % 2 ? "dd" : "dt"));
  }
  rows.forEach(([name, text, bad], i) => {
    const [term, value] = [list.children[2 * i], list.children[2 * i + 1]];
    set(term, name);
    set(value, text ?? (name && "–"));
    value.className = bad ? "bad" : "";
  });
}

export function set(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
