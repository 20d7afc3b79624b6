"""One HTML file with plots that needs nothing else: plotly.js, data and pictures are in it."""

import base64
import gzip
import html
import json

import numpy

from .needs import needs

POINTS = 1500  # of a curve, at most
COLORS = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22"]
STYLE = """
:root{color-scheme:light}*{box-sizing:border-box}
body{margin:0 auto;max-width:1500px;padding:0 12px 40px;font:15px/1.45 system-ui,sans-serif;color:#222;background:#fff}
h1{font-size:1.5em;margin:.7em 0 .1em}h2{font-size:1.2em;margin:1.6em 0 .4em;border-bottom:1px solid #ddd}h3{font-size:1em;margin:.2em 0}
.grid{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,430px),1fr));gap:14px}.grid>*{min-width:0}
.wide{overflow-x:auto;margin-bottom:10px}nav{line-height:1.9}nav a{margin-right:14px}
table{border-collapse:collapse;font-size:.92em}td,th{padding:2px 10px 2px 0;text-align:left;vertical-align:top;overflow-wrap:anywhere}
th{font-weight:600}td.n,td.ok,td.look{font-variant-numeric:tabular-nums;white-space:nowrap}td:first-child{overflow-wrap:normal}tr+tr td{border-top:1px solid #eee}
.ok{color:#18794e}.look{color:#b42318;font-weight:600}.note{color:#666}
h1,p{overflow-wrap:anywhere}
.columns td,.columns th{white-space:nowrap}
pre{white-space:pre-wrap;overflow-wrap:anywhere;background:#f7f7f7;padding:8px;font-size:.85em}
.add{background:#e6f4ea}.del{background:#fce8e6}img{max-width:100%;height:auto}summary{cursor:pointer}
@media print{.grid>*{break-inside:avoid}}
"""
SCRIPT = """
(async function(){
  const say=t=>document.querySelectorAll('.plot').forEach(d=>{d.textContent=t});
  // The page counts as loaded when the plots are there: until then a document is open in it. Otherwise a screenshot or a print without a screen is taken of empty plots.
  const open=document.body.appendChild(document.createElement('iframe'));open.hidden=true;open.contentDocument.open();
  try{
    const packed=Uint8Array.from(atob(document.getElementById('library').textContent),c=>c.charCodeAt(0));
    const text=await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'))).text();
    const script=document.createElement('script');script.textContent=text;document.head.appendChild(script);
    const figures=JSON.parse(document.getElementById('figures').textContent);
    const draw=d=>{const f=figures[d.id];
      if(d.clientWidth<500&&f.layout.showlegend)d.style.height=Math.max(d.clientHeight,300+19*f.data.length)+'px';
      Plotly.newPlot(d,f.data,f.layout,{responsive:true,displaylogo:false,displayModeBar:false})};
    for(const d of document.querySelectorAll('.plot'))draw(d);
    document.body.dataset.drawn=document.querySelectorAll('.plot .main-svg').length?'yes':'no';
  }catch(e){say('The plots need a browser of 2023 or later: '+e)}
  open.contentDocument.close();open.remove();
})();
"""


def escape(text):
    return html.escape(str(text))


def number(value):
    """For tables: six digits; counts as they are."""
    if isinstance(value, (float, numpy.floating)):
        return f"{value:.6g}" if numpy.isfinite(value) else str(value)
    return str(value)


def thinned(x, y):
    """Of a long curve the first and last point and the extremes of each stretch."""
    if len(x) <= POINTS:
        return x, y
    edges = numpy.linspace(0, len(x), (POINTS - 2) // 2 + 1).astype(int)
    stretches = [(a, numpy.nan_to_num(y[a:b])) for a, b in zip(edges, edges[1:])]
    kept = {0, len(x) - 1}.union(*({a + int(part.argmin()), a + int(part.argmax())} for a, part in stretches))
    kept = sorted(kept)
    return x[kept], y[kept]


def _plain(values):
    """For JSON, with six digits; null where a number is not finite."""
    return [float(f"{value:.6g}") if numpy.isfinite(value) else None for value in values]


def curve(x, y, name, color, dash=False):
    x, y = thinned(numpy.asarray(x), numpy.asarray(y, float))
    return {"type": "scatter", "mode": "lines" if len(x) > 1 else "markers", "x": [float(f"{value:.9g}") for value in x], "y": _plain(y), "name": name,
            "line": {"color": color, "width": 1.6, "dash": "dot" if dash else "solid"}}  # fmt: skip


def bars(names, values, label, color):
    return {"type": "bar", "orientation": "h", "x": _plain(values), "y": list(names), "name": label, "marker": {"color": color}}


class Page:
    """Sections one after the other; `text` is the file."""

    def __init__(self, title):
        self.title, self.parts, self.figures, self.links = title, [], {}, []

    def add(self, *parts):
        self.parts += parts

    def head(self, title):
        """A section, to which a link at the top leads."""
        self.links.append(f'<a href="#section{len(self.links)}">{escape(title)}</a>')
        self.add(f'<h2 id="section{len(self.links) - 1}">{escape(title)}</h2>')

    def contents(self):
        """Here stand the links to all sections."""
        self.add(CONTENTS)

    def note(self, text):
        self.add(f'<p class="note">{escape(text)}</p>')

    def plot(self, title, traces, y, x="time [s]", tall=False):
        """The figure, for `grid`."""
        name = f"plot{len(self.figures)}"
        axis = {"gridcolor": "#eee", "zerolinecolor": "#ccc", "exponentformat": "SI", "automargin": True}
        largest = max((abs(value) for trace in traces for value in trace["y"] if isinstance(value, float)), default=0)
        powers = y.startswith("over") or 0 < largest < 1e-9  # ratios and round-off have no prefixes
        legend = len(traces) > 1 or not tall and traces[0]["name"].lower() != title.lower()
        self.figures[name] = {"data": traces, "layout": {
            "margin": {"l": 55, "r": 10, "t": 30 if legend else 12, "b": 40}, "font": {"size": 12}, "hovermode": "closest", "showlegend": legend,
            "legend": {"orientation": "h", "y": 1.02, "yanchor": "bottom", "font": {"size": 11}}, "plot_bgcolor": "#fff", "paper_bgcolor": "#fff", "autosize": True,
            "xaxis": {**axis, "title": {"text": x, "standoff": 6}},
            "yaxis": {**axis, "title": {"text": y, "standoff": 6}, **({"exponentformat": "e"} if powers else {}), **({"dtick": 1} if tall else {})}}}  # fmt: skip
        height = 440 if tall else 300 + 10 * max(0, len(traces) - 4)  # room for a long legend
        return f'<div><h3>{escape(title)}</h3><div class="plot" style="height:{height}px" id="{name}"></div></div>'

    def grid(self, *parts):
        self.add('<div class="grid">', *(part for part in parts if part), "</div>")

    def table(self, header, rows):
        """Rows of texts and numbers; a text in a tuple (class, text) is marked."""

        def cell(value):
            if isinstance(value, tuple):
                return f'<td class="{value[0]}">{escape(value[1])}</td>'
            kind = "" if isinstance(value, str) else ' class="n"'
            return f"<td{kind}>{escape(number(value))}</td>"

        head = "<tr>" + "".join(f"<th>{escape(name)}</th>" for name in header) + "</tr>" if header else ""
        wraps = "" if max(map(len, [header, *rows])) < 4 else ' class="columns"'  # many columns stay whole, and scroll on a phone
        return f'<div class="wide"><table{wraps}>{head}{"".join("<tr>" + "".join(map(cell, row)) + "</tr>" for row in rows)}</table></div>'

    def picture(self, name, png):
        return f'<div><h3>{escape(name)}</h3><img alt="{escape(name)}" src="data:image/png;base64,{base64.b64encode(png).decode()}"></div>'

    @property
    def text(self):
        library = needs("plotly.offline", "A report").get_plotlyjs()
        # In a script element, </script and <!--<script mean something wherever they stand.
        figures = json.dumps(self.figures, allow_nan=False).replace("<", "\\u003c")
        return "\n".join([
            "<!DOCTYPE html>", MARK, '<html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">', f"<title>{escape(self.title)}</title>",
            f"<style>{STYLE}</style></head><body>", "\n".join(self.parts).replace(CONTENTS, f"<nav>{chr(10).join(self.links)}</nav>"), "<noscript>The plots need JavaScript; nothing is fetched.</noscript>",
            f'<script type="application/json" id="figures">{figures}</script>',
            f'<script type="text/plain" id="library">{base64.b64encode(gzip.compress(library.encode(), 9, mtime=0)).decode()}</script>',
            f"<script>{SCRIPT}</script></body></html>", ""])  # fmt: skip


MARK = "<!-- coplane report -->"
CONTENTS = "<!-- contents -->"
