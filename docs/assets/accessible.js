/* What the theme leaves unnamed for screen readers and unreachable by the keyboard. */
"use strict";
document.querySelector(".md-search")?.setAttribute("aria-label", "Search");
new MutationObserver(() => {
  for (const wide of document.querySelectorAll(".md-typeset__scrollwrap:not([tabindex])")) {
    wide.tabIndex = 0;
  }
  for (const [n, each] of document.querySelectorAll(".md-code__nav").entries()) {
    const name = `Code ${n + 1}`;
    if (each.getAttribute("aria-label") !== name) each.setAttribute("aria-label", name);
  }
}).observe(document.body, { childList: true, subtree: true });
