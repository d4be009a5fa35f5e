// Figures and tables of a page as files: SVG and PNG in the colours of paper, CSV with all digits that the page has.
"use strict";

function saveFile(name, content, type) {
  const url = URL.createObjectURL(new Blob([content], { type }));
  make("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60000);  // when it has certainly been written
}

// A row of buttons. `kinds`: {SVG, PNG, CSV: what gives the content, or a promise of it, when asked}.
const TYPES = { SVG: "image/svg+xml", PNG: "image/png", CSV: "text/csv" };
function saveButtons(title, kinds) {
  const name = title.split(":")[0].replaceAll(/[^\w.-]+/g, "_").replaceAll(/^_|_$/g, "");
  return make("span", { class: "save no-print" }, ...Object.entries(kinds).map(([kind, content]) => make("button", {
    type: "button", class: "link", "aria-label": `Save ${title} as ${kind}`,
    onclick: async () => saveFile(`${name}.${kind.toLowerCase()}`, await content(), TYPES[kind]),
  }, kind)));
}

// ---- tables ----
const csvCell = (value) => {
  const text = isNumber(value) ? String(Number(value.toPrecision(9))) : String(value ?? "");
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
};
const csvText = (rows) => rows.map((row) => `${row.map(csvCell).join(",")}\n`).join("");

// The head's cells above each column, where they reach over several columns or rows too.
function headsOf(table) {
  const rows = [...table.tHead.rows].filter((row) => row.cells.length && !row.querySelector("input"));
  const grid = rows.map(() => []);
  rows.forEach((row, r) => {
    let c = 0;
    for (const cell of row.cells) {
      while (grid[r][c] !== undefined) ++c;
      for (let down = 0; down < cell.rowSpan && r + down < rows.length; ++down) {
        for (let right = 0; right < cell.colSpan; ++right) grid[r + down][c + right] = down ? "" : cell.textContent;
      }
      c += cell.colSpan;
    }
  });
  return (grid[0] ?? []).map((_, c) => grid.map((row) => row[c]).filter(Boolean).join(" "));
}
// `unit`: of all columns but the first, where the head does not say it.
function csvOfTable(table, unit) {
  const plain = (text) => text.replaceAll("\u00a0", " ");
  const text = (cell) => (cell.textContent === "–" ? "" : plain(cell.textContent));
  const heads = headsOf(table).map((head, c) => plain(unit && c > 0 ? `${head} (${unit})` : head));
  return csvText([heads, ...[...table.tBodies[0].rows].map((row) => [...row.cells].map(text))]);
}

// ---- pictures ----
const FIGURE_WIDTH = 640;  // letters are 8 points high if it is as wide as a page's text
const PNG_SCALE = 3;
const INK = "#1b1f24";

// The result of `draw` with the colours of the light theme; the screen is not repainted meanwhile.
function inLight(draw) {
  const root = document.documentElement;
  const theme = root.dataset.theme;
  root.dataset.theme = "light";
  try { return draw(); } finally { root.dataset.theme = theme; }
}

function figureSvg(height, ...children) {
  return svg("svg", { xmlns: "http://www.w3.org/2000/svg", width: FIGURE_WIDTH, height, viewBox: `0 0 ${FIGURE_WIDTH} ${height}`, "font-family": "sans-serif", "font-size": 12 },
    svg("rect", { width: FIGURE_WIDTH, height, fill: "#fff" }), ...children);
}
const svgText = (element) => new XMLSerializer().serializeToString(element);

async function pngOfSvg(element) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svgText(element))}`;
  await image.decode();
  const canvas = make("canvas", { width: PNG_SCALE * element.getAttribute("width"), height: PNG_SCALE * element.getAttribute("height") });
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  return pngOfCanvas(canvas);
}
const pngOfCanvas = (canvas) => new Promise((resolve) => { canvas.toBlob(resolve, "image/png"); });
const pictureKinds = (draw) => ({ SVG: async () => svgText(await draw()), PNG: async () => pngOfSvg(await draw()) });

// Splits text into lines of at most `most` letters.
function wrapped(text, most) {
  const lines = [""];
  for (const word of text.split(/\s+/)) {
    const last = lines.at(-1);
    if (last && last.length + 1 + word.length > most) lines.push(word); else lines[lines.length - 1] = last ? `${last} ${word}` : word;
  }
  return lines;
}

// Names beside a piece of their line, or what `mark` draws in its place, in rows from `top` down: {elements, height}.
function legendOf(entries, top) {
  const ROW = 18;
  let [x, y] = [10, top + ROW / 2];
  const elements = entries.flatMap(({ label, stroke, width, opacity, dash, mark }) => {
    const length = 40 + TEXT_WIDTH * label.length;
    if (x > 10 && x + length > FIGURE_WIDTH) [x, y] = [10, y + ROW];
    const at = x;
    x += length;
    const line = () => [svg("line", { x1: at, x2: at + 18, y1: y, y2: y, stroke, "stroke-width": width ?? 3, "stroke-opacity": opacity ?? 1, ...dashed(dash) })];
    return [...(mark ?? line)(at, y), svg("text", { x: at + 24, y: y + 4, fill: INK }, label)];
  });
  return { elements, height: y + ROW / 2 - top };
}

const dashed = (dash) => (dash ? { "stroke-dasharray": dash.join(" ") } : {});

// ---- plots ----
// What a plot shows, as a figure: `options` are those of a plot of the size that it is called with.
function plotSvg(plot, options, title, series, xLabel, yLabel) {
  const FIGURE_HEIGHT = 300;
  const holder = make("div", { class: "unseen" });
  document.body.append(holder);
  const settings = options({ width: FIGURE_WIDTH, height: FIGURE_HEIGHT });
  settings.cursor = { show: false };
  for (const [name, { min, max }] of Object.entries(plot.scales)) settings.scales[name].range = [min, max];
  settings.series.forEach((s, k) => { s.show = plot.series[k].show; });
  return new Promise((resolve) => {
    settings.hooks = { ready: [(u) => {
      resolve(inLight(() => titledFigure(title, tracedPlot(u, series, xLabel, yLabel))));
      setTimeout(() => { u.destroy(); holder.remove(); });
    }] };
    new uPlot(settings, plot.data, holder);
  });
}

function titledFigure(title, { height, parts }) {
  const [LETTERS, LINE] = [95, 16];
  const lines = wrapped(title, LETTERS).map((line, i) => svg("text", { x: 10, y: 14 + LINE * i, fill: INK }, line));
  return figureSvg(height + LINE * lines.length + 4, ...lines, svg("g", { transform: `translate(0,${LINE * lines.length + 4})` }, ...parts));
}

// Reproduces what uPlot drew, at the same positions.
function tracedPlot(u, series, xLabel, yLabel) {
  const [left, top, width, height] = ["left", "top", "width", "height"].map((side) => u.bbox[side] / uPlot.pxRatio);
  const [right, bottom] = [left + width, top + height];
  const px = (x) => Number((left + u.valToPos(x, "x")).toFixed(2));
  const py = (y) => Number((top + u.valToPos(y, "y")).toFixed(2));
  const text = (x, y, anchor, words, more = {}) => svg("text", { x, y, "text-anchor": anchor, fill: INK, ...more }, words);
  const labelled = (axis) => (axis._splits ?? []).map((value, i) => [value, axis._values[i]]).filter(([value, words]) => value !== null && words !== null && words !== undefined && words !== "");
  const grid = [
    ...labelled(u.axes[0]).flatMap(([x, words]) => [svg("line", { x1: px(x), x2: px(x), y1: top, y2: bottom + 4, stroke: colour("grid") }), text(px(x), bottom + 17, "middle", words)]),
    ...labelled(u.axes[1]).flatMap(([y, words]) => [svg("line", { x1: left - 4, x2: right, y1: py(y), y2: py(y), stroke: colour("grid") }), text(left - 8, py(y) + 4, "end", words)])];
  const clip = svg("clipPath", { id: "plot" }, svg("rect", { x: left - 6, y: top - 6, width: width + 12, height: height + 12 }));
  const lines = svg("g", { "clip-path": "url(#plot)" }, ...series.flatMap((s, k) => (u.series[k + 1].show ? seriesSvg(u.data[0], s, px, py, asideOf(series, k)) : [])));
  const legend = legendOf(series.filter((s, k) => u.series[k + 1].show).map(legendEntry), bottom + 42);
  const parts = [svg("defs", {}, clip), ...grid, svg("path", { d: `M${left},${top}V${bottom}H${right}`, fill: "none", stroke: INK }), lines,
    text((left + right) / 2, bottom + 36, "middle", xLabel), text(0, 0, "middle", yLabel ?? "", { transform: `translate(13,${(top + bottom) / 2}) rotate(-90)` }), ...legend.elements];
  return { height: bottom + 46 + legend.height, parts };
}

// Dots where there is no line.
function legendEntry(s) {
  const dot = (x, y) => [svg("circle", { class: "key", cx: x + 9, cy: y, r: 4, fill: colour(s.colour) })];
  return { label: s.label, stroke: colour(s.colour), dash: s.dash, mark: s.onlyPoints ? dot : undefined };
}

// Line, dots and whiskers, moved `aside` as on the page.
function seriesSvg(x, s, pxOf, py, aside) {
  const px = (value) => Number((pxOf(value) + aside).toFixed(2));
  const stroke = colour(s.colour);
  const known = [...x.keys()].filter((i) => isNumber(x[i]) && isNumber(s.values[i]));
  const parts = [];
  if (!s.onlyPoints) {
    const d = known.map((i, k) => `${k && (s.spanGaps || known[k - 1] === i - 1) ? "L" : "M"}${px(x[i])},${py(s.values[i])}`).join("");
    parts.push(svg("path", { d, fill: "none", stroke, "stroke-width": s.width ?? 1.6, "stroke-linejoin": "round", ...dashed(s.dash) }));
  }
  const most = s.weights && Math.max(...s.weights);
  if (s.points) for (const i of known) parts.push(svg("circle", { cx: px(x[i]), cy: py(s.values[i]), r: most ? Math.max(1.5, 10 * Math.sqrt(s.weights[i] / most)) : 3, fill: stroke }));
  for (const i of s.low ? known : []) {
    if (!isNumber(s.low[i]) || !isNumber(s.high[i])) continue;
    const [at, low, high] = [px(x[i]), py(s.low[i]), py(s.high[i])];
    parts.push(svg("path", { d: `M${at},${low}V${high}M${at - 3},${low}h6M${at - 3},${high}h6`, fill: "none", stroke, "stroke-width": 1.5 }));
  }
  return parts;
}

// After x and `more` columns those of each series: its values, the ends of its intervals, and its weights.
function csvOfPlot(x, series, xLabel, xNames, more = []) {
  const inUnit = (s, words) => `${s.label}${words}${s.unit ? ` (${s.unit})` : ""}`;
  const columns = [...more, ...series.flatMap((s) => [[inUnit(s, ""), s.values], ...(s.low ? [[inUnit(s, ", 95 % low"), s.low], [inUnit(s, ", 95 % high"), s.high]] : []), ...(s.weights ? [[s.weighedBy, s.weights]] : [])])];
  return csvText([[xLabel, ...columns.map(([name]) => name)], ...[...x.keys()].map((i) => [xNames ? xNames[x.indexOf(x[i])] : x[i], ...columns.map(([, values]) => values[i])])]);
}
