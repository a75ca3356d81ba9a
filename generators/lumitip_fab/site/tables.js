// What a line of a table is about is shown on boards, masks and in the 3D view.
const shown = { names: [], from: null, has: () => false, listeners: [] };
const PANELS = { wires: "wires", grid: "view" };

function panelsOf(name) {
  const [kind, rest] = name.split(".");
  if (kind === "print") return [byId("bed-panel")];
  const id = PANELS[name] || (kind === "board" || kind === "mask" ? `${kind}-${rest}` : "");
  return id && byId(id) ? [byId(id)] : [];
}

function show(names, from) {
  for (const element of all(".lit")) element.classList.remove("lit");
  for (const button of all(".show")) button.setAttribute("aria-pressed", "false");
  [shown.names, shown.from] = [names, from];
  const drawn = names.flatMap((name) => parts.get(name) || nets.get(name) || []);
  const panels = names.flatMap(panelsOf);
  for (const element of [...drawn, ...panels]) element.classList.add("lit");
  for (const listener of shown.listeners) listener(names);
  byId("shown").hidden = !names.length;
  if (!names.length) return;
  const titles = [...new Set(names.map((name) => name.replace(/^print\.|@.*/g, "")))];
  const more = titles.length > 4 ? ` and ${titles.length - 4} more` : "";
  byId("shown-names").textContent = `Shown: ${titles.slice(0, 4).join(", ")}${more}`;
  from.setAttribute("aria-pressed", "true");
  // Parts and nets of boards are small in 3D, so that their drawing goes first.
  const place = drawn.find((element) => element.getClientRects().length)
    || (shown.has(names[0]) ? byId("model") : panels[0] || (drawn[0] && panelOf(drawn[0])));
  place?.scrollIntoView({ block: "center", inline: "center" });
}

document.addEventListener("click", (event) => {
  const button = event.target.closest(".show");
  if (!button) return;
  const again = button.getAttribute("aria-pressed") === "true";
  show(again ? [] : button.dataset.show.split(" "), button);
});
document.addEventListener("keydown", (event) => {
  const typed = event.target.closest?.("input, select"); // where Escape has its own meaning
  if (event.key === "Escape" && shown.names.length && !typed) back();
});
function back() {
  const from = shown.from.isConnected ? shown.from : byId("query"); // which has left its line out
  show([], from);
  from.scrollIntoView({ block: "center" });
  from.focus({ preventScroll: true });
}
byId("shown-back").addEventListener("click", back);
byId("shown-clear").addEventListener("click", () => show([], shown.from));

// The checks: sorted, filtered, and a part at a time.
const STEP = 40;
const COLUMNS = [
  ["check", "check"], ["subject", "file"], ["value", "value"], ["limit", "limit"],
  ["margin", "margin"], ["share", "margin, %"], ["note", "note"],
];
const NUMBERS = new Set(["value", "limit", "margin", "share"]);
const state = { column: null, down: false, limit: STEP };

function matching() {
  const words = byId("query").value.toLowerCase().split(/\s+/).filter(Boolean);
  const kind = byId("kind").value;
  return data.checks.filter((row) =>
    (kind !== "failed" || !row.passed)
    && (kind !== "tight" || (row.share !== null && row.share < 0.1))
    && words.every((w) => `${row.check} ${row.subject} ${row.note}`.toLowerCase().includes(w)));
}

function ordered(rows) {
  const { column, down } = state;
  if (!column) return rows;
  const key = (row) => (NUMBERS.has(column) ? parseFloat(row[column]) : row[column]);
  const known = (value) => value !== null && !Number.isNaN(value);
  return [...rows].sort((one, other) => {
    const [a, b] = [key(one), key(other)];
    if (!known(a) || !known(b)) return known(b) - known(a);
    const order = a < b ? -1 : Number(a > b);
    return down ? -order : order;
  });
}

function cellOf(row, name) {
  const cell = document.createElement("td");
  if (NUMBERS.has(name)) cell.className = "n";
  if (name === "share") {
    if (row.share === null) return cell;
    const bar = document.createElement("span");
    bar.className = "bar";
    bar.style.backgroundSize = `${100 * Math.min(Math.max(row.share, 0), 1)}% 100%`;
    cell.append(bar, `${(100 * row.share).toFixed(row.share < 0.1 ? 1 : 0)} %`);
    return cell;
  }
  const unit = NUMBERS.has(name) && name !== "limit" && row[name] ? row.unit : "";
  cell.textContent = unit ? `${row[name]} ${unit}` : row[name];
  if (name === "check" && !row.passed) {
    cell.append(Object.assign(document.createElement("strong"), {
      className: "bad", textContent: " fails",
    }));
  }
  return cell;
}

function lineOf(row) {
  const line = document.createElement("tr");
  line.append(...COLUMNS.map(([name]) => cellOf(row, name)));
  const go = Object.assign(document.createElement("td"), { className: "go" });
  if (row.show.length) {
    const button = Object.assign(document.createElement("button"), {
      type: "button", className: "show", textContent: "show",
    });
    button.dataset.show = row.show.join(" ");
    button.setAttribute("aria-label", `Show ${row.check} of ${row.subject}`);
    button.setAttribute("aria-pressed", "false");
    go.append(button);
  }
  line.append(go);
  return line;
}

// Lines that are drawn anew have new buttons, one of them for what is shown.
function findShower() {
  if (!shown.names.length || shown.from.isConnected) return;
  const same = (button) => ["data-show", "aria-label"].every((name) =>
    button.getAttribute(name) === shown.from.getAttribute(name));
  const found = all("#check-table .show").find(same);
  found?.setAttribute("aria-pressed", "true");
  shown.from = found || shown.from;
}

function drawChecks() {
  const rows = ordered(matching());
  byId("check-table").tBodies[0].replaceChildren(...rows.slice(0, state.limit).map(lineOf));
  findShower();
  const failed = rows.filter((row) => !row.passed).length;
  byId("count").textContent = `${rows.length} of ${data.checks.length} measurements, `
    + `${failed} fail`;
  byId("more").hidden = rows.length <= state.limit;
  for (const [at, [name]] of COLUMNS.entries()) {
    if (name === "limit") continue;
    const order = state.column !== name ? "none" : state.down ? "descending" : "ascending";
    byId("check-table").tHead.rows[0].cells[at].setAttribute("aria-sort", order);
  }
}

function headChecks() {
  const heads = COLUMNS.map(([name, title]) => {
    const head = Object.assign(document.createElement("th"), { scope: "col" });
    if (NUMBERS.has(name)) head.className = "n";
    if (name === "limit") { // a range in words, in the unit of its line, has no order
      head.textContent = title;
      return head;
    }
    const button = Object.assign(document.createElement("button"), { type: "button" });
    button.textContent = title;
    button.addEventListener("click", () => {
      [state.down, state.column] = [state.column === name && !state.down, name];
      drawChecks();
    });
    head.append(button);
    return head;
  });
  const place = Object.assign(document.createElement("th"), { scope: "col", className: "go" });
  place.innerHTML = '<span class="hidden">place</span>';
  byId("check-table").tHead.rows[0].append(...heads, place);
}

headChecks();
drawChecks();
for (const id of ["query", "kind"]) {
  byId(id).addEventListener("input", () => {
    state.limit = STEP;
    drawChecks();
  });
}
byId("more").addEventListener("click", () => {
  state.limit += 10 * STEP;
  drawChecks();
});
