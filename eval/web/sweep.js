// The page of a sweep: headline, failures, settings; starts everything.
"use strict";

function subtitle() {
  const axes = AXES.filter((axis) => axis.texts.length > 1).map((axis) => `${axis.texts.length} ${axis.key}`);
  const seeds = largest(POINTS, (p) => p.runs);
  // For axes that are not crossed with each other the number of points is more useful.
  const crossed = AXES.reduce((product, axis) => product * axis.texts.length, 1) === POINTS.length;
  const size = [...(crossed ? axes : [`${POINTS.length} points of ${AXES.map((axis) => axis.key).join(", ")}`]), ...(seeds > 1 ? [SWEEP.seed_keys.length > 1 ? `${seeds} of ${SWEEP.seed_keys.join(", ")}` : `${seeds} seeds`] : [])].join(" x ");
  const state = SWEEP.finished === SWEEP.planned ? `${SWEEP.finished} ${SWEEP.finished === 1 ? "run" : "runs"}` : `${SWEEP.finished} of ${SWEEP.planned} runs so far`;
  byId("subtitle").textContent = `${state}${size ? `: ${size}` : ""}${SWEEP.failed ? `; ${SWEEP.failed} failed` : ""}`;
  byId("of").textContent = SWEEP.of;
  byId("of").hidden = !SWEEP.of;
}

function headline() {
  const card = (value, text) => make("div", { class: "card" }, make("b", {}, value), make("span", {}, text));
  const best = metric.better === "neither" ? -1 : metric.mean.reduce((found, value, i) => (isNumber(value) && (found < 0 || isBetter(value, metric.mean[found])) ? i : found), -1);
  const rough = (value, unit = true) => (unit ? withUnit : compact)(rounded(value, 3));
  const cards = [];
  if (best >= 0) {
    const place = AXES.filter((axis) => axis.texts.length > 1).map((axis) => `${shortKey(axis.key)} ${axis.labels[POINTS[best].values[AXES.indexOf(axis)]]}`);
    cards.push(card(rough(metric.mean[best]), place.length ? `best mean, at ${place.join(", ")}` : "mean of the only point"));
    if (isNumber(metric.low[best])) cards.push(card(`${rough(metric.low[best], false)} – ${rough(metric.high[best])}`, "its 95 % interval"));
  }
  const line = linesAlong(along.axis).find((l) => l.points.includes(best));
  const axis = AXES[along.axis];
  const held = line && heldText(line);
  if (line?.alike) {
    cards.push(card("no effect", `of ${shortKey(axis.key)}${held === "all" ? "" : ` at ${held}`}: all its values give the same`));
  } else if (line) {
    cards.push(card(axis.labels[POINTS[line.points[line.best]].values[along.axis]], `best ${shortKey(axis.key)}${held === "all" ? "" : ` at ${held}`}${hasUnlikeSeeds(line) ? `, over the ${line.seeds} seeds that all its points have` : ""}`));
    if (line.seeds > 1) cards.push(card(line.low === line.high ? compact(line.low) : `${compact(line.low)} – ${compact(line.high)}`, `95 % interval of the best ${shortKey(axis.key)}`));
    if (line.seeds > 1) cards.push(card(rough(metric.shown(line.regret_of_seed[line.best])), `regret: its mean loss against ${oracleOf(line)}`));
  }
  byId("headline").replaceChildren(...cards);
  byId("direction").textContent = aimText();
}

function initFailures() {
  const failures = Object.entries(SWEEP.runs?.failures ?? {});
  if (!failures.length) { byId("failures-section").remove(); return; }
  // Reasons that differ only in numbers are grouped.
  const kinds = new Map();
  for (const [row, reason] of failures) {
    const kind = reason.replace(/\d[\d.e+-]*/g, "#");
    kinds.set(kind, [...(kinds.get(kind) ?? []), { row: Number(row), reason }]);
  }
  const line = (group) => {
    const rows = group.map(({ row }) => row);
    const reasons = new Set(group.map(({ reason }) => reason));
    return [String(rows.length), settingsOf(rows), someOf(rows.map((row) => SWEEP.runs.run[row])), `${reasons.size > 1 ? "such as: " : ""}${group[0].reason}`];
  };
  byId("failures").append(tableOf(["failed", "at", "runs", "reason"], [...kinds.values()].map(line)));
}

// For each axis of which these runs do not cover all values: the values that they have.
function settingsOf(rows) {
  const parts = AXES.map((axis, i) => {
    const values = [...new Set(rows.map((row) => POINTS[SWEEP.runs.point[row]].values[i]))].sort((a, b) => a - b);
    return values.length < axis.texts.length ? `${shortKey(axis.key)} ${someOf(values.map((k) => axis.labels[k]))}` : "";
  });
  return parts.filter(Boolean).join(", ") || "all settings";
}

function someOf(items) {
  const MOST = 8;
  return items.length <= MOST ? items.join(", ") : `${items.slice(0, MOST - 1).join(", ")}, … ${items.at(-1)}`;
}

function initEnvironment() {
  const meaning = { experiment: "every effective key", given: "those of these keys that a file or --set gives", sweep: "with its axes written out", again: "sweep_again.yaml, which beside experiment.yaml repeats this sweep" };
  for (const [key, text] of Object.entries(SWEEP.environment)) {
    if (key === "sweep" && SWEEP.environment.again) continue;  // the same, less readable
    byId("environment").append(text.includes("\n") ? make("details", {}, make("summary", {}, meaning[key] ? `${key}: ${meaning[key]}` : key), make("pre", {}, text)) : make("p", {}, `${key}: ${text}`));
  }
}

initTheme();
if (METRICS.length) {
  const options = METRICS.map((m) => make("option", { value: m.name }, metricLabel(m)));
  byId("metric").append(...options);
  byId("metric").value = metric.name;
  byId("metric").addEventListener("change", (event) => chooseMetric(event.target.value));
  changed.push(headline);
  along.by = AXES.findIndex((axis, i) => repeats(i) && repeats(along.axis) && isCrossed(i, along.axis));
  if (AXES.length) {
    changed.push(drawAlong);
    drawAlong();
    headline();
    initHeat();
  } else {  // only seeds
    for (const id of ["plot-section", "best-section", "heat-section"]) byId(id).remove();
    headline();
  }
  initTable();
} else {
  for (const id of ["chooser", "headline", "plot-section", "best-section", "heat-section", "table-section"]) byId(id).remove();
}
subtitle();
initFailures();
initEnvironment();
document.documentElement.dataset.ready = "true";
