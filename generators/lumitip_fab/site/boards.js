// The drawings of the boards: layers on and off, seen from the front or the back, and larger.
for (const id of ["front", "back", "fills", "openings", "silk", "bodies"]) {
  const box = byId(id);
  const apply = () => document.body.classList.toggle(`no-${id}`, !box.checked);
  box.addEventListener("change", apply);
  apply();
}

// From the back a board is mirrored, and the layers lie the other way round.
function seenFrom(side) {
  const back = side === "back";
  if (document.body.classList.contains("from-back") === back) return;
  document.body.classList.toggle("from-back", back);
  for (const svg of all("svg.board")) {
    const { x, width } = svg.viewBox.baseVal;
    const [sheet, copper] = [".sheet", ".copper"].map((name) => svg.querySelector(name));
    sheet.setAttribute("transform", back ? `translate(${2 * x + width} 0) scale(-1 1)` : "");
    copper.append(...[...copper.children].reverse());
    const label = svg.getAttribute("aria-label");
    svg.setAttribute("aria-label", label.replace(/from its (front|back)/, `from its ${side}`));
  }
}
byId("side").addEventListener("change", (event) => seenFrom(event.target.value));
seenFrom(byId("side").value); // a browser keeps it when the page is loaded again

for (const button of all(".larger")) {
  button.addEventListener("click", () => {
    const panel = panelOf(button);
    button.setAttribute("aria-pressed", String(panel.classList.toggle("large")));
    panel.scrollIntoView();
  });
}
