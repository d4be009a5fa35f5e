// What all report pages share: theme, small HTML helpers, numbers and plots.
"use strict";
const byId = (id) => document.getElementById(id);

function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "class") element.className = value;
    else if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

function svg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

// URL of a path relative to this page; names of folders may contain any character.
const linkOf = (path) => path.split("/").map(encodeURIComponent).join("/");

const isNumber = (value) => typeof value === "number" && Number.isFinite(value);
// For any number of items: not every browser allows 100,000 arguments in a call.
const largest = (items, of) => items.reduce((most, item) => Math.max(most, of(item)), 0);
const fixed = (value, digits) => (isNumber(value) ? value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1") : "–");
// Rounded to `digits` significant digits, but never beyond the decimal point: a rounded number must not look like an exact count.
const rounded = (value, digits) => (Math.abs(value) >= 10 ** (digits - 1) && Math.abs(value) < 1e15 ? Math.round(value) : Number(value.toPrecision(digits)));
// 4 significant digits without trailing zeros.
const compact = (value) => (isNumber(value) ? String(rounded(value, 4)) : "–");
// Metres in readable form.
function metres(value) {
  if (!isNumber(value)) return "–";
  const size = Math.abs(value);
  if (size < 0.01) return `${fixed(value * 1000, 1)} mm`;
  if (size < 1) return `${fixed(value * 100, 1)} cm`;
  return `${fixed(value, 2)} m`;
}
// The unit is the end of a metric's name.
const UNITS = { m_per_s: "m/s", m_per_m: "m/m", m: "m", rad: "rad", deg: "°", s: "s", us: "µs", mib: "MiB", cells: "cells" };
const UNIT_END = new RegExp(`_(${Object.keys(UNITS).join("|")})$`);
const unitOf = (name) => UNITS[name.match(UNIT_END)?.[1]] ?? "";
// The best unit for most of the values: millimetres or centimetres where lengths are small, degrees for radians.
// `label` is the name without its original unit.
function suitedUnit(name, values) {
  const unit = unitOf(name);
  const sizes = values.filter(isNumber).map(Math.abs).sort((a, b) => a - b);
  const usual = sizes[Math.floor((sizes.length - 1) / 2)] ?? 0;
  let [factor, shown] = [1, unit];
  if (/^m(\/|$)/.test(unit) && usual < 1) [factor, shown] = usual < 0.01 ? [1000, `m${unit}`] : [100, `c${unit}`];
  if (unit === "rad") [factor, shown] = [180 / Math.PI, "°"];
  return { factor, unit: shown, label: shown === unit ? name : name.replace(UNIT_END, "") };
}
const percent = (value) => (isNumber(value) ? `${fixed(value * 100, 1)} %` : "–");
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

// The width between the margins of A4 and US letter paper: the page is still as wide as the
// window when the browser says that it is about to print.
const PRINT_WIDTH = 690;
let printing = false;
const widthFor = (container, least, otherwise) => (printing ? PRINT_WIDTH : Math.max(least, container.clientWidth || otherwise));

// ---- theme ----
const themeListeners = [];  // called to redraw in the theme's colours
function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  const button = byId("theme");
  if (button) button.textContent = theme === "dark" ? "Light" : "Dark";
  for (const listener of themeListeners) listener();
}
function initTheme() {
  const wanted = window.matchMedia("(prefers-color-scheme: dark)");
  const current = () => document.documentElement.dataset.theme;
  setTheme(wanted.matches ? "dark" : "light");
  wanted.addEventListener("change", () => setTheme(wanted.matches ? "dark" : "light"));
  byId("theme").addEventListener("click", () => setTheme(current() === "dark" ? "light" : "dark"));
  // Paper is white, and nothing on it can be opened.
  let onScreen = null;
  window.addEventListener("beforeprint", () => {
    onScreen = current();
    printing = true;
    setTheme("light");  // which redraws everything
    for (const details of document.querySelectorAll("details")) details.open = true;
  });
  window.addEventListener("afterprint", () => {
    printing = false;
    if (onScreen) setTheme(onScreen);
  });
}

function tableOf(head, rows) {
  return make("table", { class: "grid" },
    make("thead", {}, make("tr", {}, ...head.map((text) => make("th", { scope: "col" }, text)))),
    make("tbody", {}, ...rows.map((row) => make("tr", {}, ...row.map((cell) => make("td", {}, cell))))));
}

// ---- painting on a canvas ----
// Stops of matplotlib's viridis (CC0): perceptually uniform, readable without colour vision.
const VIRIDIS = [[68, 1, 84], [65, 68, 135], [42, 120, 142], [34, 168, 132], [122, 209, 81], [253, 231, 37]];
function viridis(share) {
  const position = Math.max(0, Math.min(1, share)) * (VIRIDIS.length - 1);
  const below = Math.min(Math.floor(position), VIRIDIS.length - 2);
  return VIRIDIS[below].map((low, i) => Math.round(low + (position - below) * (VIRIDIS[below + 1][i] - low)));
}
const rgb = (parts) => `rgb(${parts.join(",")})`;

// A canvas of that many CSS pixels, `scale` of its own for each.
function canvasPainted(canvas, scale, width, height, paint) {
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  const context = canvas.getContext("2d");
  context.scale(scale, scale);
  context.font = "11px system-ui, sans-serif";
  paint(context, width, height);
  return canvas;
}

// paint(context, width, height) is called now and whenever the theme changes.
function paintedCanvas(width, height, label, paint) {
  const canvas = make("canvas", { role: "img", "aria-label": label });
  const redraw = () => canvasPainted(canvas, devicePixelRatio, width, height, paint);
  canvas.style.width = `${width}px`;
  canvas.style.maxWidth = "100%";
  themeListeners.push(redraw);
  canvas.redraw = redraw;
  redraw();
  return canvas;
}

// ---- plots ----
const allPlots = [];
const TEXT_WIDTH = 7;  // of a label's letter, pixels

// Enough digits to distinguish the values on the axis, and at least those asked for.
function digitsOn(scale, least) {
  const span = Math.abs(scale.max - scale.min);
  return span > 0 ? Math.max(least, Math.min(6, 1 - Math.floor(Math.log10(span)))) : least;
}

function seriesOf(s) {
  const say = (u, v, i) => `${s.digits === undefined ? compact(v) : fixed(v, digitsOn(u.scales.y, s.digits))}${s.unit ? ` ${s.unit}` : ""}${s.notes && i != null ? ` ${s.notes[i]}` : ""}`;
  return {
    label: s.label, stroke: colour(s.colour), width: s.width ?? 1.6, dash: s.dash, show: s.show !== false,
    points: { show: Boolean(s.points) && !s.weights, size: 7, fill: colour(s.colour) }, spanGaps: Boolean(s.spanGaps), paths: s.onlyPoints ? () => null : undefined,
    value: (u, v, k, i) => (isNumber(v) ? say(u, v, i) : "–"),
  };
}

// How far a series with whiskers is moved sideways, so that those of several can be told apart; CSS pixels.
const asideOf = (series, k) => (series[k].low ? (k - (series.length - 1) / 2) * 3 : 0);

// Moves what uPlot draws of the series.
function movedAside(options, aside) {
  if (!aside) return options;
  const moved = (paths) => (u, k, from, to) => {
    const drawn = paths(u, k, from, to);
    if (!drawn?.stroke) return drawn;
    const by = new DOMMatrix().translate(aside * devicePixelRatio, 0);
    const move = (path) => { if (!(path instanceof Path2D)) return path; const copy = new Path2D(); copy.addPath(path, by); return copy; };
    return { ...drawn, stroke: move(drawn.stroke), fill: move(drawn.fill), clip: null };
  };
  return { ...options, paths: options.paths ?? moved(uPlot.paths.linear()), points: { ...options.points, paths: moved(uPlot.paths.points()) } };
}

// Points whose areas are proportional to their weights.
function drawWeighted(u, series) {
  const MOST_RADIUS = 10;
  const LEAST_RADIUS = 1.5;
  series.forEach((s, k) => {
    if (!s.weights || !u.series[k + 1].show) return;
    const most = Math.max(...s.weights);
    u.ctx.fillStyle = colour(s.colour);
    u.data[0].forEach((x, i) => {
      const radius = Math.max(LEAST_RADIUS, MOST_RADIUS * Math.sqrt(s.weights[i] / most)) * devicePixelRatio;
      u.ctx.beginPath();
      u.ctx.arc(u.valToPos(x, "x", true), u.valToPos(s.values[i], "y", true), radius, 0, 2 * Math.PI);
      u.ctx.fill();
    });
  });
}

// Whiskers from low to high at every point of the series that have them, moved aside with it.
function drawIntervals(u, series) {
  series.forEach((s, k) => {
    if (!s.low || !u.series[k + 1].show) return;
    u.ctx.save();
    u.ctx.beginPath();
    u.ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    u.ctx.clip();
    u.ctx.strokeStyle = colour(s.colour);
    u.ctx.lineWidth = 1.5 * devicePixelRatio;
    u.ctx.beginPath();
    u.data[0].forEach((x, i) => {
      if (!isNumber(s.low[i]) || !isNumber(s.high[i])) return;
      const px = u.valToPos(x, "x", true) + asideOf(series, k) * devicePixelRatio;
      const [low, high] = [u.valToPos(s.low[i], "y", true), u.valToPos(s.high[i], "y", true)];
      const cap = 3 * devicePixelRatio;
      u.ctx.moveTo(px, low); u.ctx.lineTo(px, high);
      u.ctx.moveTo(px - cap, low); u.ctx.lineTo(px + cap, low);
      u.ctx.moveTo(px - cap, high); u.ctx.lineTo(px + cap, high);
    });
    u.ctx.stroke();
    u.ctx.restore();
  });
}

// Range that goes no farther than `within`: single values beyond leave the plot, so that all others can be told apart.
const rangeWithin = ([least, most]) => (u, low, high) => uPlot.rangeNum(Math.min(Math.max(low ?? 0, least), most), Math.max(Math.min(high ?? 1, most), least), 0.1, true);
// Range of a logarithmic axis that begins at `least`; smaller values are not shown.
const rangeFrom = (least) => (u, low, high) => uPlot.rangeLog(least, Math.max(high ?? 0, 10 * least), 10, true);

// The y range must hold the whiskers too, not only the points.
function rangeWithIntervals(series, log) {
  return (u, low, high) => {
    series.forEach((s, k) => {
      if (!s.low || !u.series[k + 1].show) return;
      for (const v of [...s.low, ...s.high]) if (isNumber(v)) { low = Math.min(low, v); high = Math.max(high, v); }
    });
    return log ? uPlot.rangeLog(low, high, 10, false) : uPlot.rangeNum(low, high, 0.1, true);
  };
}

// Makes the legend's names accessible by keyboard.
function openLegendToKeys(u, title) {
  u.root.querySelectorAll(".u-legend .u-series").forEach((row, k) => {
    if (k === 0) return;
    const label = row.querySelector("th");
    label.tabIndex = 0;
    label.setAttribute("role", "button");
    const say = () => label.setAttribute("aria-label", `${u.series[k].label}: ${u.series[k].show ? "shown" : "hidden"} in ${title}`);
    label.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      event.stopPropagation();
      u.setSeries(k, { show: !u.series[k].show });
      say();
    });
    say();
  });
}

// The range of x after zooming about the cursor.
function zoomed(u, x, factor) {
  const { min, max } = u.scales.x;
  const at = u.cursor.idx != null ? x[u.cursor.idx] : (min + max) / 2;
  const [all_min, all_max] = [x[0], x[x.length - 1]];
  return { min: Math.max(all_min, at - (at - min) * factor), max: Math.min(all_max, at + (max - at) * factor) };
}

// Shortened in the middle if it is longer, because similar names differ at their ends.
function shortened(text, most) {
  if (text.length <= most) return text;
  const kept = Math.max(2, most - 1);
  return `${text.slice(0, Math.ceil(kept / 2))}…${text.slice(text.length - Math.floor(kept / 2))}`;
}

// Where a logarithmic axis is labelled: at whole decades if there are several, else between them
// too, and in a part of one at the plotted values themselves.
function logTicks(x, low, high) {
  const decades = Math.log10(high / low);
  const steps = decades > 3 ? [1] : decades > 1 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 8];
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power) {
    for (const step of steps) ticks.push(Number(`${step}e${power}`));
  }
  const inside = ticks.filter((v) => v >= low && v <= high);
  return inside.length > 2 ? inside : [...new Set(x)].filter((v) => v >= low && v <= high);
}

// Labels of a linear axis, with the decimals of its ticks.
function linearLabels(u, ticks, k, space, step) {
  let decimals = 0;
  while (decimals < 12 && Math.abs(step - Number(step.toFixed(decimals))) > 1e-6 * step) ++decimals;
  return ticks.map((v) => fixed(v, decimals));
}
// Ticks without labels are null.
const logLabels = (u, ticks) => ticks.map((v) => (v === null ? null : compact(v)));

// A plot with its own title and legend. `series`: {label, values, colour (a CSS variable), dash, digits, unit,
// points, weights (of points; weighedBy: what they are), notes (behind the values), low, high (ends of intervals)}.
// Lines stop where a value is null. Plots of one `sync` key share their cursor. `caption` and `note`: what a picture's file
// says besides the title. `columns`: further ones of a CSV, [name, values]. `xNames` replaces the numbers of the x axis, one a value of x. `leastY`: where an axis of `logY` begins.
// `withinY`: the ends beyond which a y axis does not go.
// Keys: left and right move the cursor, + and - zoom, 0 shows everything.
function drawPlot(container, { title, caption, note, columns, x, xLabel, yLabel, series, height = 190, sync, onCursor, xNames, logX, logY, leastY, withinY }) {
  const help = `${title}. Arrow keys move the cursor, plus and minus zoom, 0 shows everything.`;
  const save = saveButtons(title, { ...pictureKinds(() => plotSvg(plot, options, `${title}${caption ? ` (${caption})` : ""}${note ? `. ${note}` : ""}`, series, xLabel, yLabel)), CSV: () => csvOfPlot(x, series, xLabel, xNames, columns) });
  const box = make("div", { class: "plot", tabindex: "0", role: "group", "aria-label": help }, make("h3", {}, title, save));
  container.append(box);
  let plot = null;
  let quiet = false;  // the cursor is being moved by another plot
  const width = () => widthFor(container, 280, 1100);
  // Dots and whiskers at the ends must not be clipped.
  const roomAround = (u, low, high) => {
    if (xNames) return [Math.min(low, high) - 0.5, high + 0.5];
    if (logX) return [low * (low / high) ** 0.02, high * (high / low) ** 0.02];
    const room = (high - low) * 0.02 || Math.abs(high) * 0.1 || 1;
    return [low - room, high + room];
  };
  const options = (size = { width: width(), height }) => {
    const axis = { stroke: colour("muted"), grid: { stroke: colour("grid"), width: 1 }, ticks: { stroke: colour("grid"), size: 5 } };
    return {
      ...size,
      cursor: sync ? { y: false, sync: { key: sync } } : { y: false },
      scales: { x: { time: false, distr: logX ? 3 : 1, range: series.some((s) => s.points) ? roomAround : undefined }, y: { distr: logY ? 3 : 1, ...(series.some((s) => s.low) ? { range: rangeWithIntervals(series, logY) } : leastY ? { range: rangeFrom(leastY) } : withinY ? { range: rangeWithin(withinY) } : {}) } },
      axes: [
        { ...axis, label: xLabel, labelSize: 20, labelGap: 0, size: 34,
          ...(xNames ? { splits: () => x, values: (u) => xNames.map((name) => shortened(name, Math.floor(u.bbox.width / devicePixelRatio / xNames.length / TEXT_WIDTH))) } : {}),
          ...(logX ? { splits: (u, k, low, high) => logTicks(x, low, high), values: logLabels, filter: (u, ticks) => ticks } : xNames ? {} : { values: linearLabels }) },
        { ...axis, label: yLabel, labelSize: yLabel ? 18 : 0, labelGap: 2, values: logY ? logLabels : linearLabels,
          size: (u, labels) => Math.max(52, 17 + TEXT_WIDTH * Math.max(0, ...(labels ?? []).map((text) => text?.length ?? 0))) }],
      series: [{ label: xLabel, value: (u, v) => (xNames ? xNames[x.indexOf(v)] ?? "–" : compact(v)) }, ...series.map((s, k) => movedAside(seriesOf(s), asideOf(series, k)))],
      hooks: {
        setCursor: onCursor ? [(u) => { if (!quiet && u.cursor.event && u.cursor.idx != null) { shown = u.cursor.idx; onCursor(shown); } }] : [],
        draw: [(u) => { drawIntervals(u, series); drawWeighted(u, series); }],
        ready: [() => { if (shown !== null) setTimeout(() => show(shown)); }],
      },
    };
  };
  const draw = () => {
    // When redrawn in other colours or for paper it keeps its range.
    const before = plot && state();
    if (plot) plot.destroy();
    const settings = options();
    if (before) {
      settings.series.forEach((s, k) => { s.show = before.shown[k]; });
      // The shown range already includes the margin.
      const { range } = settings.scales.x;
      if (range) settings.scales.x.range = (u, low, high) => (low === before.min && high === before.max ? [low, high] : range(u, low, high));
    }
    plot = new uPlot(settings, [x, ...series.map((s) => s.values)], box);
    if (before) setRange(before);
    openLegendToKeys(plot, title);
  };
  const state = () => ({ min: plot.scales.x.min, max: plot.scales.x.max, shown: plot.series.map((s) => s.show) });
  const setRange = ({ min, max }) => plot.setScale("x", { min, max });
  // Like dragging, for all plots that share the cursor.
  const zoomTo = (range) => { for (const other of allPlots) if (other.box === box || (sync && other.sync === sync)) other.setRange(range); };
  let shown = null;
  const show = (i) => {
    if (!isNumber(x[i])) return;
    shown = i;
    quiet = true;
    plot.setCursor({ left: plot.valToPos(x[i], "x"), top: plot.over.clientHeight / 2 }, false);
    quiet = false;
  };
  draw();
  box.addEventListener("keydown", (event) => {
    if (event.target !== box) return;
    const step = { ArrowRight: 1, ArrowLeft: -1, PageUp: 30, PageDown: -30 }[event.key];
    if (step) {
      const i = Math.max(0, Math.min(x.length - 1, (shown ?? plot.cursor.idx ?? 0) + step));
      show(i);
      if (onCursor) onCursor(i);
    } else if (event.key === "+" || event.key === "=") zoomTo(zoomed(plot, x, 0.7));
    else if (event.key === "-") zoomTo(zoomed(plot, x, 1 / 0.7));
    else if (event.key === "0") zoomTo({ min: x[0], max: x[x.length - 1] });
    else return;
    event.preventDefault();
  });
  themeListeners.push(draw);
  new ResizeObserver(() => plot.setSize({ width: width(), height })).observe(container);
  allPlots.push({ box, show, sync, setRange, state });
  return box;
}
