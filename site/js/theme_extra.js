document.addEventListener("DOMContentLoaded", () => {
  renderMathInElement(document.body, {delimiters: [{left: "\\(", right: "\\)", display: false}, {left: "\\[", right: "\\]", display: true}]});
  for (const table of document.querySelectorAll(".rst-content table")) {
    table.classList.add("docutils");
    const wide = document.createElement("div");
    wide.className = "wy-table-responsive";
    table.replaceWith(wide);
    wide.append(table);
  }
});
