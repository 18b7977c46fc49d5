// What scrolls sideways can be reached with the keyboard: code, and tables in the boxes that the theme gives them.
const sizes = new ResizeObserver((boxes) => {
  for (const { target: box } of boxes) {
    if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
    else box.removeAttribute("tabindex");
  }
});
addEventListener("load", () => {
  // Until now the live coupe's picture is shown.
  document.querySelector(".live")?.classList.add("loaded");
  let heading = "";
  const found = "article :is(h1, h2, h3, h4, pre > code, .md-code__nav, .md-typeset__scrollwrap)";
  for (const each of document.querySelectorAll(found)) {
    if (each.matches("h1, h2, h3, h4")) heading = each.firstChild.textContent.trim();
    // The button that copies code is no navigation.
    else if (each.matches("nav")) each.role = "none";
    else sizes.observe(each);
    if (each.matches("div")) {
      each.role = "group";
      each.ariaLabel = `Table: ${heading}`;
    }
  }
});
