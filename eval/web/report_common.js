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

const isNumber = (value) => typeof value === "number" && Number.isFinite(value);
const fixed = (value, digits) => (isNumber(value) ? value.toFixed(digits) : "–");
// Metres as a person says them.
function metres(value) {
  if (!isNumber(value)) return "–";
  const size = Math.abs(value);
  if (size < 0.01) return `${(value * 1000).toFixed(1)} mm`;
  if (size < 1) return `${(value * 100).toFixed(1)} cm`;
  return `${value.toFixed(2)} m`;
}
const percent = (value) => (isNumber(value) ? `${(value * 100).toFixed(1)} %` : "–");
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

const themeListeners = [];
function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  for (const listener of themeListeners) listener();
}
function initTheme() {
  const wanted = window.matchMedia("(prefers-color-scheme: dark)");
  setTheme(wanted.matches ? "dark" : "light");
  wanted.addEventListener("change", () => setTheme(wanted.matches ? "dark" : "light"));
  byId("theme").addEventListener("click", () =>
    setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
}

function tableOf(head, rows) {
  return make("table", { class: "grid" },
    make("thead", {}, make("tr", {}, ...head.map((text) => make("th", { scope: "col" }, text)))),
    make("tbody", {}, ...rows.map((row) => make("tr", {}, ...row.map((cell) => make("td", {}, cell))))));
}

// A plot with its own title and legend. `series`: {label, values, colour (a CSS variable), dash,
// digits, unit}. Lines stop where a value is null. Plots of one `sync` key share their cursor.
function drawPlot(container, { title, x, xLabel, series, height = 190, sync, onCursor }) {
  const box = make("div", { class: "plot" }, make("h3", {}, title));
  container.append(box);
  let plot = null;
  const draw = () => {
    if (plot) plot.destroy();
    const axis = { stroke: colour("muted"), grid: { stroke: colour("grid"), width: 1 }, ticks: { stroke: colour("grid") } };
    plot = new uPlot({
      width: Math.max(280, container.clientWidth || 1100),
      height,
      cursor: sync ? { sync: { key: sync } } : {},
      scales: { x: { time: false } },
      axes: [{ ...axis, label: xLabel, labelSize: 22, size: 40 }, { ...axis, size: 64 }],
      series: [{ label: xLabel, value: (u, v) => fixed(v, 2) }, ...series.map((s) => ({
        label: s.label, stroke: colour(s.colour), width: 1.6, dash: s.dash, show: s.show !== false,
        points: { show: false }, spanGaps: false,
        value: (u, v) => (isNumber(v) ? `${v.toFixed(s.digits ?? 3)}${s.unit ? ` ${s.unit}` : ""}` : "–"),
      }))],
      hooks: onCursor ? { setCursor: [(u) => { if (u.cursor.event && u.cursor.idx != null) onCursor(u.cursor.idx); }] } : {},
    }, [x, ...series.map((s) => s.values)], box);
  };
  draw();
  themeListeners.push(draw);
  new ResizeObserver(() => plot.setSize({ width: Math.max(280, container.clientWidth), height })).observe(container);
  return box;
}
