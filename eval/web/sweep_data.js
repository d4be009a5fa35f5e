// Shared by the parts of a sweep's page: its data, the selected metric and the selection of grid points.
"use strict";
const SWEEP = JSON.parse(byId("data").textContent);
// Counts and seeds in full.
const exact = (value) => (Number.isInteger(value) ? String(value) : compact(value));
// Without the folders that all of these paths begin with.
function withoutCommonFolder(paths) {
  const parts = paths.map((path) => path.split("/"));
  const shortest = Math.min(...parts.map((part) => part.length - 1));
  let common = 0;
  while (common < shortest && parts.every((part) => part[common] === parts[0][common])) ++common;
  return parts.map((part) => part.slice(common).join("/"));
}

// Scenes by their own names, files without folder and extension, if they remain distinct.
function nameLabels({ key, texts, names = [] }) {
  if (key !== "scene" && key !== "trajectory") return texts;
  const short = texts.map((text, i) => names[i] || text.split("/").at(-1).replace(/\.\w+$/, ""));
  if (new Set(short).size === texts.length) return short;
  return withoutCommonFolder(texts);
}
// `texts` are as they were set, `labels` as they are shown.
const AXES = SWEEP.axes.map((axis) => ({ ...axis, labels: axis.numeric ? axis.numbers.map(exact) : nameLabels(axis) }));
const POINTS = SWEEP.points;
// What an oracle chooses the best value for: of crossed seeds a run has one of each.
const EACH = SWEEP.crossed_seeds ? "run" : "seed";

// Metrics in the form shown. Those of one quantity, such as an error before and after mapping, have one unit.
const quantityOf = (score) => score.split(".").at(-1);
const VALUES_OF = new Map();
for (const { score, mean } of SWEEP.metrics) VALUES_OF.set(quantityOf(score), [...(VALUES_OF.get(quantityOf(score)) ?? []), ...mean]);
const METRICS = SWEEP.metrics.map((metric) => {
  const suited = suitedUnit(metric.score, VALUES_OF.get(quantityOf(metric.score)));
  const label = metric.name.replace(metric.score, () => suited.label);  // a distance keeps its bars
  // What rounding leaves of nothing, such as 4e-16 m of true poses, is shown as 0.
  const shown = (v) => (Math.abs(v) < 1e-12 ? 0 : v * suited.factor);
  const scale = (values) => values.map((v) => (v === null ? null : shown(v)));
  return { ...metric, ...suited, label, shown, mean: scale(metric.mean), median: scale(metric.median), low: scale(metric.low), high: scale(metric.high) };
}).sort((a, b) => (a.main || Infinity) - (b.main || Infinity) || a.score.localeCompare(b.score) || a.name.length - b.name.length);
let metric = METRICS[0];
const withUnit = (value, m = metric) => (isNumber(value) ? `${compact(value)}${m.unit ? ` ${m.unit}` : ""}` : "–");
const metricLabel = (m = metric) => (m.unit ? `${m.label} (${m.unit})` : m.label);
const isBetter = (a, b, m = metric) => (m.better === "higher" ? a > b : m.better === "lower" && a < b);
const aimText = (m = metric) => (m.better === "neither" ? "neither more nor less is better" : `${m.better} is better`);

// The main axis: the numeric one with the most values; on ties the gain first.
function mainAxis() {
  const numeric = AXES.map((axis, i) => i).filter((i) => AXES[i].numeric && AXES[i].texts.length > 1);
  const isGain = (i) => (AXES[i].key === "mapper.fusion.gain" ? 1 : 0);
  return numeric.sort((a, b) => AXES[b].texts.length - AXES[a].texts.length || isGain(b) - isGain(a))[0] ?? 0;
}
const shortKey = (key) => key.split(".").at(-1);

const changed = [];  // called when the metric or anything that shapes all parts changes
function chooseMetric(name) {
  metric = METRICS.find((m) => m.name === name) ?? metric;
  for (const listener of changed) listener();
}

// A labelled <select>; options are [value, label].
function select(label, id, options, chosen, onChange) {
  const element = make("select", { id, onchange: (event) => onChange(event.target.value) },
    ...options.map(([value, text]) => make("option", { value: String(value) }, text)));
  element.value = String(chosen);
  return make("label", { for: id }, `${label} `, element);
}

// Which of the other axes must be held so that a plot over `used` shows one point a place: those
// that are not already decided by the used ones (as in a zip).
function freeAxes(used) {
  return AXES.map((axis, i) => i).filter((i) => {
    if (used.includes(i) || AXES[i].texts.length < 2) return false;
    const seen = new Map();
    return POINTS.some(({ values }) => {
      const place = used.map((u) => values[u]).join();
      if (!seen.has(place)) { seen.set(place, values[i]); return false; }
      return seen.get(place) !== values[i];
    });
  });
}

// Whether each value of one axis occurs with several of the other; false if they change together.
const isCrossed = (i, k) => freeAxes([i]).includes(k) && freeAxes([k]).includes(i);

// Whether the axis repeats: several points have the same value of it, as in a grid. Where all are
// drawn at random, or change together, there is nothing to hold and no line to follow.
const repeats = (i) => AXES[i].texts.length > 1 && POINTS.length >= 1.5 * AXES[i].texts.length;

// The first value of an axis that any point has the metric at: runs of those before may have failed.
function firstKnown(axis) {
  const known = POINTS.filter((point, i) => isNumber(metric.mean[i])).map((point) => point.values[axis]);
  return known.length ? Math.min(...known) : 0;
}

// Held values of the free axes, one a part of the page: {axis: index into its texts, or -1 for any}. Each offers what
// there is with those before it held: of axes that change together not every combination is there.
function holders(prefix, held, free, redraw) {
  let points = POINTS;
  return free.map((i) => {
    held[i] ??= firstKnown(i);
    const there = new Set(points.map(({ values }) => values[i]));
    if (held[i] !== -1 && !there.has(held[i])) held[i] = Math.min(...there);
    points = points.filter(({ values }) => held[i] === -1 || values[i] === held[i]);
    const options = [...AXES[i].labels.map((text, k) => [k, text]).filter(([k]) => there.has(k)), [-1, "any"]];
    return select(AXES[i].key, `${prefix}-held-${i}`, options, held[i], (value) => { held[i] = Number(value); redraw(); });
  });
}
const anyOf = (held, free) => free.filter((i) => held[i] === -1);
// ", at gain 0.5, over all 3 values of movers": what a figure's title says of the axes that it does not show.
function heldTitle(held, free) {
  const at = free.filter((i) => held[i] !== -1).map((i) => `${shortKey(AXES[i].key)} ${AXES[i].labels[held[i]]}`);
  const any = anyOf(held, free).map((i) => `all ${AXES[i].texts.length} values of ${AXES[i].key}`);
  return `${at.length ? `, at ${at.join(", ")}` : ""}${any.length ? `, over ${any.join(" and ")}` : ""}`;
}
const fits = (values, held, free) => free.every((i) => held[i] === -1 || values[i] === held[i]);

// The lines of the grid along an axis, as in the statistics: those with a best value, or else all.
function allLinesAlong(axis) {
  return metric.lines?.[AXES[axis]?.key] ?? [];
}
const linesAlong = (axis) => allLinesAlong(axis).filter((line) => line.best !== undefined);
