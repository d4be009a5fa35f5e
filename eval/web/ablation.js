// The page of an ablation: how much of each score's error every stage causes.
"use strict";
const ABLATION = JSON.parse(byId("data").textContent);
const [BAR_WIDTH, BAR_HEIGHT] = [240, 22];
const nameOf = (word) => word.replaceAll("_", " ");

// Shares of one score, on one scale.
function scaleOf(score) {
  const shares = Object.values(score.truth_for).flatMap((stage) => [stage.share, ...intervalOf(score, stage)]);
  const known = shares.filter(isNumber);
  const [low, high] = [Math.min(0, ...known), Math.max(1, ...known)];
  return (share) => ((share - low) / (high - low)) * (BAR_WIDTH - 4) + 2;
}

function intervalOf(score, stage) {
  if (!stage.owned_interval95 || !(score.error > 0)) return [];
  return stage.owned_interval95.map((owned) => owned / score.error);
}

function barOf(score, stage, name, at) {
  if (!isNumber(stage.share)) return "";
  const [zero, end] = [at(0), at(stage.share)];
  const picture = svg("svg", { class: "share", viewBox: `0 0 ${BAR_WIDTH} ${BAR_HEIGHT}`, role: "img", "aria-label": `${name}: ${percent(stage.share)} of the error` },
    svg("rect", { class: stage.share < 0 ? "below" : "above", x: Math.min(zero, end), y: 5, width: Math.abs(end - zero), height: 12 }),
    svg("line", { class: "zero", x1: zero, x2: zero, y1: 1, y2: BAR_HEIGHT - 1 }));
  const interval = intervalOf(score, stage).map(at);
  if (interval.length === 2) picture.append(svg("line", { x1: interval[0], x2: interval[1], y1: 11, y2: 11 }), ...interval.map((x) => svg("line", { x1: x, x2: x, y1: 7, y2: 15 })));
  return picture;
}

// Scale above the bars: 0 and all of the error.
function scaleHead(at) {
  // Letter width of a narrow page, where letters are wider relative to the bar.
  const [HALF_ZERO, HALF_ALL, GAP] = [6, 26, 6];
  const all = Math.min(Math.max(at(1), HALF_ALL + 2 * HALF_ZERO + GAP), BAR_WIDTH - HALF_ALL);
  const none = Math.min(Math.max(at(0), HALF_ZERO), all - HALF_ALL - GAP - HALF_ZERO);
  const labels = [[none, "0"], [all, "100 %"]].map(([x, text]) => svg("text", { x, y: 15, "text-anchor": "middle" }, text));
  return svg("svg", { class: "share", viewBox: `0 0 ${BAR_WIDTH} ${BAR_HEIGHT}`, role: "img", "aria-label": "share of the error" }, ...labels);
}

// A score's table with all digits.
function csvOfScore(stages, { unit, factor }) {
  const inUnit = (text) => (unit ? `${text} (${unit})` : text);
  const scaled = (value) => (isNumber(value) ? value * factor : value);
  const heads = ["truth for", "share", ...["error", "owned", "owned, 95 % low", "owned, 95 % high"].map(inUnit), "p (Holm)"];
  return csvText([heads, ...stages.map(([name, stage]) => [nameOf(name), stage.share, scaled(stage.error), scaled(stage.owned), ...(stage.owned_interval95 ?? ["", ""]).map(scaled), stage.p_holm])]);
}

function initScores() {
  for (const [metric, score] of Object.entries(ABLATION.scores)) {
    const at = scaleOf(score);
    const stages = Object.entries(score.truth_for);
    const anyShare = stages.some(([, stage]) => isNumber(stage.share));
    const suited = suitedUnit(metric, [score.error, ...stages.map(([, stage]) => stage.error)]);
    const { unit, factor, label } = suited;
    const show = (value) => (isNumber(value) ? compact(value * factor) : "–");
    const rows = stages.map(([name, stage]) => [
      nameOf(name), percent(stage.share), ...(anyShare ? [barOf(score, stage, name, at)] : []), show(stage.error), show(stage.owned),
      stage.owned_interval95 ? `${show(stage.owned_interval95[0])} to ${show(stage.owned_interval95[1])}` : "–", compact(stage.p_holm)]);
    const inUnit = (text) => (unit ? `${text} (${unit})` : text);
    const what = score.error_is === "the score" ? label : `1 − ${label}`;
    byId("scores").append(make("h3", {}, `${what}: ${show(score.error)}${unit ? ` ${unit}` : ""} as it is`, saveButtons(`ablation ${metric}`, { CSV: () => csvOfScore(stages, suited) })),
      make("div", { class: "scroll" }, tableOf(["truth for", "share", ...(anyShare ? [scaleHead(at)] : []), ...["error", "owned", "95 % interval"].map(inUnit), "p"], rows)));
  }
}

function initStages() {
  for (const stage of ABLATION.stages) {
    byId("stages").append(make("dt", {}, nameOf(stage.name)), make("dd", {}, `${stage.meaning} (against ${nameOf(stage.against)})`));
  }
}

initTheme();
byId("subtitle").textContent = `${ABLATION.seeds} ${ABLATION.seeds === 1 ? "seed" : "seeds"}${ABLATION.seeds < 8 ? " (fewer than 8 prove nothing)" : ""}${ABLATION.of ? `: ${ABLATION.of}` : ""}`;
if (ABLATION.changed) byId("changed").textContent = `Not the default: ${ABLATION.changed}`;
initStages();
initScores();
byId("settings").textContent = ABLATION.settings;
document.documentElement.dataset.ready = "true";
