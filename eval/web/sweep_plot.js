// The metric along an axis, with a line for each value of another; and the axis' best value.
"use strict";
// Whether values are more evenly spaced on a logarithmic scale, as with `scale: log`.
function isLogarithmic({ numeric, numbers }) {
  if (!numeric || numbers.length < 3 || numbers.some((v) => v <= 0)) return false;
  const unevenness = (values) => {
    const steps = [...values].sort((a, b) => a - b).map((v, i, all) => v - all[i - 1]).slice(1);
    return Math.max(...steps) / Math.max(Math.min(...steps), 1e-12);
  };
  return unevenness(numbers.map(Math.log)) < unevenness(numbers);
}
const along = { axis: mainAxis(), by: -1, held: {}, logX: AXES.length > 0 && isLogarithmic(AXES[mainAxis()]), logY: false };
const PALETTE = ["est", "slam", "truth", "invented", "missed", "online", "muted"];
const MOST_LINES = PALETTE.length;

// As many values as are distinguishable, evenly spread.
function shownValues(axis) {
  const count = AXES[axis].texts.length;
  if (count <= MOST_LINES) return [...AXES[axis].texts.keys()];
  return [...Array(MOST_LINES).keys()].map((i) => Math.round(i * (count - 1) / (MOST_LINES - 1)));
}

// Whether an axis only rises, or only falls, along another: in a zip it does, at random it does not.
function monotone(points, along, other) {
  const sorted = [...points].sort((a, b) => POINTS[a].values[along] - POINTS[b].values[along]).map((i) => POINTS[i].values[other]);
  const steps = sorted.slice(1).map((v, k) => Math.sign(v - sorted[k]));
  return !steps.includes(1) || !steps.includes(-1);
}

function plotSeries(free) {
  const lines = along.by < 0 ? [null] : shownValues(along.by);
  const axis = AXES[along.axis];
  const chosen = POINTS.map((point, i) => i).filter((i) => fits(POINTS[i].values, along.held, free));
  const position = (i) => (axis.numeric ? axis.numbers[POINTS[i].values[along.axis]] : POINTS[i].values[along.axis]);
  // Several points at one x, as where an axis is not held: drawn as a cloud, not a line.
  const crowded = new Set(chosen.map((i) => `${position(i)} ${along.by < 0 ? "" : POINTS[i].values[along.by]}`)).size < chosen.length;
  // So are points that differ in more than what is drawn, as those of a random sweep or of named variants.
  const isAlike = (points, i) => (AXES[i].numeric ? monotone(points, along.axis, i) : new Set(points.map((point) => POINTS[point].values[i])).size < 2);
  const isScattered = (value) => {
    const points = chosen.filter((i) => value === null || POINTS[i].values[along.by] === value);
    return AXES.some((other, i) => i !== along.axis && i !== along.by && !isAlike(points, i));
  };
  const order = [...chosen].sort((a, b) => position(a) - position(b));
  const x = crowded ? order.map(position) : [...new Set(order.map(position))];
  const series = lines.map((value, k) => {
    const slots = x.map(() => null);
    order.forEach((i, place) => {
      if (value !== null && POINTS[i].values[along.by] !== value) return;
      slots[crowded ? place : x.indexOf(position(i))] = i;
    });
    const pick = (values) => slots.map((i) => (i === null ? null : values[i]));
    return {
      label: value === null ? "mean" : `${shortKey(AXES[along.by].key)} ${AXES[along.by].labels[value]}`, values: pick(metric.mean), low: pick(metric.low), high: pick(metric.high),
      colour: PALETTE[k], unit: metric.unit, points: true, onlyPoints: crowded || !axis.numeric || isScattered(value), spanGaps: true,
    };
  });
  // Where several points have one x, what else they differ in.
  const columns = crowded ? anyOf(along.held, free).map((i) => [AXES[i].key, order.map((point) => AXES[i].labels[POINTS[point].values[i]])]) : [];
  return { x, series, columns };
}

// What dots and whiskers are.
function dotsNote(free) {
  const seeds = largest(POINTS, (p) => p.counting);
  const any = anyOf(along.held, free).map((i) => AXES[i].key);
  return `Dots: mean over ${seeds > 1 ? `up to ${seeds} ${SWEEP.seed_keys.length > 1 ? "runs" : "seeds"}` : "one seed"}${any.length ? `, one for each value of ${any.join(" and ")}` : ""}.` +
    (seeds > 1 ? ` Whiskers: bootstrap 95 % interval of the mean (${metric.resamples} resamples).` : "");
}

function drawAlong() {
  byId("plot").replaceChildren();
  const used = along.by < 0 ? [along.axis] : [along.axis, along.by];
  const free = freeAxes(used);
  const controls = [
    select("Axis", "plot-axis", AXES.map((axis, i) => [i, axis.key]), along.axis, (value) => { along.axis = Number(value); along.logX = isLogarithmic(AXES[along.axis]); if (along.by === along.axis) along.by = -1; drawAlong(); }),
    select("A line each", "plot-by", [[-1, "none"], ...AXES.map((axis, i) => [i, axis.key]).filter(([i]) => i !== along.axis && AXES[i].texts.length > 1)], along.by, (value) => { along.by = Number(value); drawAlong(); }),
    ...holders("plot", along.held, free, drawAlong),
  ];
  const axis = AXES[along.axis];
  const checkbox = (id, key, label) => {
    const box = make("input", { type: "checkbox", id, onchange: (event) => { along[key] = event.target.checked; drawAlong(); } });
    box.checked = along[key];
    controls.push(make("label", { for: id }, box, ` ${label}`));
  };
  const positive = axis.numeric && axis.numbers.every((v) => v > 0);
  const positiveValues = [...metric.mean, ...metric.low].every((v) => v === null || v > 0);
  if (positive) checkbox("plot-log", "logX", "logarithmic axis");
  if (positiveValues) checkbox("plot-log-values", "logY", "logarithmic values");
  keepFocus(byId("plot-controls"), controls);
  const { x, series, columns } = plotSeries(free);
  drawPlot(byId("plot"), {
    title: `${metric.label} along ${axis.key}${heldTitle(along.held, free)}`, caption: SWEEP.of, note: dotsNote(free), columns, x, xLabel: axis.key, yLabel: metric.unit || "value", series, height: 340,
    xNames: axis.numeric ? undefined : x.map((i) => axis.labels[i]), logX: positive && along.logX, logY: positiveValues && along.logY,
  });
  const sum = (of) => POINTS.reduce((total, p) => total + of(p), 0);
  const repeats = sum((p) => p.runs - p.counting);
  byId("plot-note").textContent = `${dotsNote(free)} ` +
    (repeats ? `A seed with the same scores as another one, as where nothing is random, counts once: ${repeats} of ${sum((p) => p.runs)} runs are such repeats. ` : "") +
    (SWEEP.crossed_seeds ? `${SWEEP.seed_keys.join(" and ")} are crossed: a mean is as sure as one of ${SWEEP.crossed_seeds} seeds. ` : "") +
    (along.by >= 0 && AXES[along.by].texts.length > MOST_LINES ? `${MOST_LINES} of the ${AXES[along.by].texts.length} values of ${AXES[along.by].key} are shown.` : "");
  drawBest();
}

// Replaces a row of controls without losing the one that was just used.
function keepFocus(row, controls) {
  const focused = document.activeElement?.id;
  row.replaceChildren(...controls);
  if (focused) row.querySelector(`#${CSS.escape(focused)}`)?.focus();
}

// ---- best value ----
function heldText(line) {
  const values = POINTS[[...line.points, ...line.left_out][0]].values;
  const parts = AXES.map((axis, i) => (i === along.axis || axis.texts.length < 2 ? "" : `${shortKey(axis.key)} ${axis.labels[values[i]]}`));
  return parts.filter(Boolean).join(", ") || "all";
}

// Why these points have no figure: runs failed, or the score has no value where it can have none.
function whyMissing(points) {
  if (!SWEEP.runs) return SWEEP.failed ? " (see Failed runs)" : "";  // of so many it is not on the page
  const some = points.filter((i) => POINTS[i].runs === 0).length;
  return some === 0 ? " (no run failed: the score has no value there)" : some === points.length ? " (see Failed runs)" : " (see Failed runs; elsewhere the score has no value)";
}

// Why nothing is compared along an axis; empty if it is, or if there is nothing to choose.
function whyNoLines(axis) {
  if (axis.texts.length < 2) return "";
  if (!axis.numeric) return `No best value: those of ${axis.key} are no numbers; the means above compare them.`;
  if (!metric.lines) return `No best value of ${metric.label}: only the main scores, first in the list, have one.`;
  if (metric.better === "neither") return `No best value of ${metric.label}: ${aimText()}.`;
  return `No best value: no two points differ in ${axis.key} alone.`;
}

// Which values are excluded from it, or why there is none.
function missingText(axis) {
  const all = allLinesAlong(along.axis);
  if (!all.length) return whyNoLines(axis);
  const why = (lines) => whyMissing(lines.flatMap((line) => line.left_out));
  const labels = (points) => points.map((i) => axis.labels[POINTS[i].values[along.axis]]).join(", ");
  const where = (line) => (heldText(line) === "all" ? "" : ` (${heldText(line)})`);
  const few = all.filter((line) => line.points.length < 2);
  const apart = all.filter((line) => line.best === undefined && line.points.length > 1);
  const cut = all.filter((line) => line.best !== undefined && line.left_out.length);
  const list = (lines, text) => someOf(lines.map((line) => `${text(line)}${where(line)}`));
  return [
    cut.length ? `Left out, as no run there gave a figure${why(cut)}: ${list(cut, (line) => labels(line.left_out))}.` : "",
    few.length ? `No best value where fewer than two values have a figure${why(few)}: ${list(few, (line) => (line.points.length ? `only ${labels(line.points)}` : "none"))}.` : "",
    apart.length ? `No best value where no seed gave a figure at every value: ${list(apart, (line) => labels(line.points))}.` : "",
  ].filter(Boolean).join(" ");
}

// Points that were stopped early, or of which a run failed, have other seeds than their neighbours.
const hasUnlikeSeeds = (line) => new Set(line.points.map((i) => POINTS[i].runs)).size > 1;

// What regret is measured against.
const oracleOf = (line) => (line.to_oracle ? "the oracle's run (mapper.fusion.mode) of the same seed and other settings" : `the best value of each ${EACH}`);
const oraclesOf = (lines) => [...new Set(lines.filter((line) => line.best !== undefined).map(oracleOf))].join(", or, where a run of the oracle is missing, against ");

// The table's content as numbers, one row per value, for further use.
function csvOfBest(lines, axis) {
  const unit = metric.unit ? ` (${metric.unit})` : "";
  const heads = ["held", axis.key, `mean${unit}`, `95 % low${unit}`, `95 % high${unit}`, "p (Holm)", "best in resamples", `regret${unit}`, "regret to", "is best", "best 95 % low", "best 95 % high", "seeds"];
  const rows = lines.flatMap((line) => line.points.map((i, k) => [heldText(line), axis.labels[POINTS[i].values[along.axis]],
    metric.mean[i], metric.low[i], metric.high[i], k === line.best ? "" : line.p?.[k], line.share_best?.[k],
    line.regret_of_seed ? line.regret_of_seed[k] * metric.factor : "", line.to_oracle ? "oracle" : "best value", k === line.best && !line.alike ? 1 : 0, line.low, line.high, line.seeds]));
  return csvText([heads, ...rows]);
}

function drawBest() {
  const axis = AXES[along.axis];
  const lines = linesAlong(along.axis);
  const missing = missingText(axis);
  byId("best-section").hidden = !lines.length && !missing;
  byId("best-missing").textContent = missing;
  byId("best-note").textContent = "";
  byId("best").replaceChildren();
  byId("regret").replaceChildren();
  if (!lines.length) return;
  byId("best-note").textContent = `Of ${axis.key}, for ${metric.label} (${aimText()}). The interval is that of the best value over resampled seeds; ` +
    "“as good” are the values that a Wilcoxon signed-rank test (Holm's correction, 5 %) does not tell from the best. Regret of one value for all seeds: what it loses against " + oraclesOf(lines) + "." +
    (lines.some(hasUnlikeSeeds) ? " Where points of a line have different seeds (stopped early, or with a failed run) only the seeds that all have are compared, so that the best may be another than that of the means above." : "");
  // The surest that so many pairs can be, all of one sign, is 2^(1 - n); Holm takes it times the number of tests.
  const canTell = (line, seeds) => 2 ** (1 - seeds) * (line.points.length - 1) < 0.05;
  const at = (line, k) => axis.labels[POINTS[line.points[k]].values[along.axis]];
  const rows = lines.map((line) => {
    const asGood = line.p.map((value, k) => [value, k]).filter(([value, k]) => k === line.best || (isNumber(value) && value >= 0.05)).map(([, k]) => at(line, k));
    const mean = compact(metric.mean[line.points[line.best]]);
    if (line.alike) return [heldText(line), "none: no effect", "–", "–", mean, "all give the same", "–", String(line.seeds)];
    if (line.seeds < 2) return [heldText(line), at(line, line.best), "–", "–", mean, "one seed tells nothing", "–", String(line.seeds)];
    return [heldText(line), at(line, line.best), line.low === line.high ? compact(line.low) : `${compact(line.low)} to ${compact(line.high)}`,
      percent(line.share_best[line.best]),
      `${mean} (${compact(metric.low[line.points[line.best]])} to ${compact(metric.high[line.points[line.best]])})`,
      !canTell(line, line.seeds) ? "too few seeds to tell" : asGood.length > 6 ? `${asGood.length} of ${line.points.length}` : asGood.join(", "),
      compact(rounded(metric.shown(line.regret_of_seed[line.best]), 3)), String(line.seeds)];
  });
  const inUnit = metric.unit ? `, ${metric.unit}` : "";
  const table = tableOf(["held", `best ${shortKey(axis.key)}`, "95 % interval", "best in resamples", `mean there${inUnit} (95\u00a0%)`, "as good", `regret${inUnit}`, "seeds"], rows);
  table.id = "best";
  byId("best").replaceWith(table);
  byId("best-note").append(saveButtons(`best ${axis.key} for ${metric.label}`, { CSV: () => csvOfBest(lines, axis) }));
  const longest = Math.max(...lines.map((line) => line.points.length + line.left_out.length));
  if (longest < 3) return;
  const shown = lines.filter((line) => line.points.length + line.left_out.length === longest);
  const place = (i) => POINTS[i].values[along.axis];
  const places = [...new Set(shown.flatMap((line) => line.points.map(place)))].sort((a, b) => a - b);
  const x = places.map((value) => axis.numbers[value]);
  const regretAt = (line, value) => line.regret_of_seed[line.points.findIndex((i) => place(i) === value)] ?? null;
  const some = shown.length <= MOST_LINES ? shown : [...Array(MOST_LINES).keys()].map((k) => shown[Math.round(k * (shown.length - 1) / (MOST_LINES - 1))]);
  drawPlot(byId("regret"), {
    title: `Regret along ${axis.key}: mean loss against ${oraclesOf(some)}${some.length < shown.length ? ` (${some.length} of the ${shown.length} rows above, as more lines would hide each other)` : ""}`, caption: `${metric.label}${SWEEP.of ? `; ${SWEEP.of}` : ""}`, x, xLabel: axis.key, yLabel: metric.unit || "value", height: 220,
    logX: along.logX && axis.numbers.every((v) => v > 0),
    series: some.map((line, k) => ({ label: heldText(line), values: places.map((value) => regretAt(line, value)).map((v) => (v === null ? null : metric.shown(v))), colour: PALETTE[k], unit: metric.unit, points: true, spanGaps: true,
      width: 1.6 + 0.9 * (some.length - 1 - k) })),  // those beneath show on both sides where many lie at 0
  });
}
