// The page of one run: headline, samples, numbers; starts everything.
"use strict";

// ---- headline ----
// Length of a path, in steps of 0.25 m, so that the poses' jitter does not add up.
function wayOf(path) {
  let way = 0, last = null;
  for (let i = 0; i < path.x.length; i++) {
    if (path.x[i] === null) continue;
    const step = last === null ? 0 : Math.hypot(path.x[i] - path.x[last], path.y[i] - path.y[last]);
    if (last !== null && step < 0.25) continue;
    way += step;
    last = i;
  }
  return way;
}

function largestCorrection() {
  const { slam, est } = RUN.paths;
  const movedBy = (i) => (est.x[i] === null || slam.x[i] === null ? 0 : Math.hypot(est.x[i] - slam.x[i], est.y[i] - slam.y[i]));
  return est.x.reduce((most, _, i) => Math.max(most, movedBy(i)), 0);
}

function median(values) {
  const known = values.filter(isNumber).sort((a, b) => a - b);
  return known.length ? known[Math.floor(known.length / 2)] : null;
}

function headline() {
  const cards = [];
  const add = (value, text) => cards.push(make("div", { class: "card" }, make("b", {}, value), make("span", {}, text)));
  const m = RUN.metrics;
  const known = (path) => path.x.filter((x) => x !== null).length;
  const [posed, tracked] = [known(RUN.paths.est), known(RUN.paths.slam)];
  const others = tracked < frameCount ? `, of the ${tracked} ${tracked === 1 ? "frame" : "frames"} that it tracked` : "";
  if (m) {
    const seen = m.map.observable ?? m.map.all;
    add(fixed(seen.occupied.f1, 3), `F1 of ${m.map.observable ? "observable " : ""}walls, 1-cell tolerance`);
    add(percent(m.map.coverage), "of the observable cells mapped");
    add(metres(m.map.chamfer_m), "chamfer distance of the walls");
    if (isNumber(m.map.navigability?.success_rate)) add(percent(m.map.navigability.success_rate), "of sampled routes are planned on the map and free in truth");
    add(metres(m.trajectory.slam?.mean_euclidean_m), `SLAM's mean error, not aligned${others}`);
    add(metres(m.trajectory.est?.mean_euclidean_m), "mean error of the estimate, not aligned");
    add(metres(m.trajectory.est?.ate_rmse_se2_m), "ATE of the estimate, aligned in the plane");
    if (posed < frameCount) add(`${frameCount - posed} of ${frameCount}`, "frames without any pose: SLAM was lost; no error counts them");
  } else {
    if (RUN.only_placed) {
      add(`${posed} of ${frameCount}`, "frames placed in the finished map");
      add(String(RUN.prior_scans), "scans in that map, none added");
    } else {
      add(String(frameCount), "frames");
      if (posed < frameCount) add(`${frameCount - posed} of ${frameCount}`, `frames without a pose: ${RUN.input_poses} was lost`);
      // No more scans are kept of a place that has been seen well, though every frame is mapped.
      const kept = RUN.own_scans === posed ? "frames mapped" : "scans kept, which the map is drawn from";
      add(String(RUN.own_scans), RUN.prior_scans ? `scans added to the finished map's ${RUN.prior_scans}` : kept);
    }
    add(`${fixed(wayOf(RUN.paths.est), 1)} m`, `path length of the estimate; ${RUN.input_poses}'s: ${fixed(wayOf(RUN.paths.slam), 1)} m`);
    add(metres(largestCorrection()), `largest correction of ${RUN.input_poses}'s poses${RUN.prior_scans ? " after the start in that map" : ""}`);
    add(fixed(median(frames.match_score), 2), "share of the beams that the map explains, median");
    add(`${fixed(RUN.map.width * RUN.map.resolution, 1)} x ${fixed(RUN.map.height * RUN.map.resolution, 1)} m`, "extent");
  }
  byId("headline").append(...cards);
  byId("subtitle").textContent = RUN.subtitle;
  if (RUN.changed) byId("changed").textContent = `Not the default: ${RUN.changed}`;
}

// ---- warnings, samples, numbers, settings ----
function initWarnings() {
  const lines = RUN.warnings.split("\n").filter((line) => line);
  if (lines.length) byId("warnings").append(...lines.map((line) => make("li", {}, line)));
  else byId("warnings-section").remove();
}

function initSamples() {
  if (!RUN.samples.length) { byId("samples-section").remove(); return; }
  if (RUN.only_placed) byId("samples-note").textContent = "Depth: bright is near, grey could not be measured.";
  for (const sample of RUN.samples) {
    const figure = (source, text) => make("figure", {}, make("img", { src: source, alt: `${text} of frame ${sample.frame}` }),
      make("figcaption", {}, `Frame ${sample.frame}: ${text}`));
    const depth = RUN.only_placed ? "depth" : "depth with the scan";
    const row = make("div", { class: "samples-row" });
    if (sample.colour) row.append(figure(sample.colour, "colour"));
    row.append(figure(sample.depth, depth));
    byId("samples").append(row);
  }
}

// All scores of the map in metrics.json beyond cell scores; a run may lack any of them.
function furtherMapNumbers(map) {
  const rows = [];
  const add = (label, value, show) => { if (isNumber(value)) rows.push([label, show(value)]); };
  const plain = (value) => fixed(value, 3);
  const { walls, registered, navigability: ways, calibration, truthless, truthless_of_truth: trueTruthless } = map;
  add("F1 of walls within 5 cm", walls?.f1_5cm, plain);
  add("F1 of walls within 10 cm", walls?.f1_10cm, plain);
  add("estimated walls to true ones, mean", walls?.estimate_to_truth_m, metres);
  add("true walls to estimated ones, mean", walls?.truth_to_estimate_m, metres);
  if (registered) rows.push(["registration to the truth", `${metres(registered.x_m)}, ${metres(registered.y_m)}, ${fixed(registered.yaw_rad * 180 / Math.PI, 2)}°`]);
  add("shift of walls by this registration, mean", registered?.mean_shift_m, metres);
  add("chamfer distance once registered", registered?.chamfer_m, metres);
  add("Hausdorff 95 % once registered", registered?.hausdorff95_m, metres);
  add("F1 within 5 cm once registered", registered?.f1_5cm, plain);
  if (map.wall_thickness) rows.push(["thickness of walls, mean (truth)", `${metres(map.wall_thickness.mean_m)} (${metres(map.true_wall_thickness?.mean_m)})`]);
  if (map.wall_thickness) rows.push(["thickness of walls, 95 % (truth)", `${metres(map.wall_thickness.p95_m)} (${metres(map.true_wall_thickness?.p95_m)})`]);
  add("double walls", map.double_wall_rate, percent);
  add("probabilities: Brier score", calibration?.brier, plain);
  add("probabilities: log loss", calibration?.log_loss, plain);
  add("probabilities: calibration error", calibration?.calibration_error, plain);
  add("correlation (MCC) of walls, observable cells", map.observable?.occupied_mcc, plain);
  add("correlation (MCC) of free cells, observable cells", map.observable?.free_mcc, plain);
  add("structural similarity (SSIM)", map.ssim, plain);
  if (truthless) rows.push(["occupied share, corners, enclosed areas (truth)", `${percent(truthless.occupied_share)}, ${truthless.corners}, ${truthless.enclosed_areas} (${percent(trueTruthless?.occupied_share)}, ${trueTruthless?.corners}, ${trueTruthless?.enclosed_areas})`]);
  add("routes planned on the map and free in truth", ways?.success_rate, percent);
  add("routes wrongly thought blocked", ways?.falsely_blocked_rate, percent);
  add("planned routes that collide", ways?.collision_rate, percent);
  add("length of planned routes against the shortest", ways?.length_ratio, plain);
  return rows;
}

// For each path: rotation errors, relative errors, drift, and the share that was compared.
const degrees = (rad) => (isNumber(rad) ? `${fixed(rad * 180 / Math.PI, 3)}°` : "–");
const FURTHER_OF_PATHS = [
  ["heading, mean, not aligned", (s) => degrees(s.heading_mean_rad)],
  ["heading, rmse, not aligned", (s) => degrees(s.heading_rmse_rad)],
  ["heading, rmse, SE(2) aligned", (s) => degrees(s.heading_rmse_se2_rad)],
  ["rotation with tilt, mean, not aligned", (s) => degrees(s.rotation_rad?.unaligned?.mean)],
  ["rotation with tilt, rmse, not aligned", (s) => degrees(s.rotation_rad?.unaligned?.rmse)],
  ["relative turn per frame, rmse", (s) => degrees(s.rpe_frame_rmse_rad)],
  ["relative turn per metre, rmse", (s) => degrees(s.rpe_metre_rmse_rad)],
  ["drift per second, over 10 s", (s) => (isNumber(s.drift_m_per_s) ? `${metres(s.drift_m_per_s)}/s` : "–")],
  ["drift per metre", (s) => percent(s.drift_m_per_m)],
  ["ATE rmse in xyz, Sim(3) aligned", (s) => metres(s.ate_rmse_sim3_m)],
  ["scale of that alignment", (s) => fixed(s.sim3_scale, 4)],
  ["share of the true poses that the estimate covers", (s) => percent(s.time_coverage)],
];

function initNumbers() {
  const m = RUN.metrics;
  if (!m) { byId("numbers-section").remove(); return; }
  const t = m.trajectory;
  const names = [["slam", "SLAM"], ["online", "estimate at the time"], ["est", "estimate at the end"]].filter(([n]) => t[n]);
  const row = (label, pick) => [label, ...names.map(([n]) => fixed(pick(t[n]), 4))];
  byId("numbers").append(make("h3", {}, "Trajectory, metres"), make("div", { class: "scroll" }, tableOf(["", ...names.map(([, label]) => label)], [
    row("mean distance in xy, not aligned", (s) => s.mean_euclidean_m),
    row("ATE rmse in xy, not aligned", (s) => s.ate_rmse_m),
    row("ATE rmse in xy, first pose aligned", (s) => s.ate_rmse_origin_m),
    row("ATE rmse in xy, SE(2) aligned", (s) => s.ate_rmse_se2_m),
    row("mean distance in xyz, not aligned", (s) => s.mean_euclidean_xyz_m),
    row("ATE rmse in xyz, SE(3) aligned", (s) => s.ate_rmse_se3_m),
    row("relative error per frame, rmse", (s) => s.rpe_frame_rmse_m),
    row("relative error per metre, rmse", (s) => s.rpe_metre_rmse_m),
  ])));
  const told = FURTHER_OF_PATHS.map(([label, say]) => [label, ...names.map(([n]) => say(t[n]))]).filter(([, ...cells]) => cells.some((cell) => cell !== "–"));
  byId("numbers").append(make("h3", {}, "Trajectory, further scores"), make("div", { class: "scroll" }, tableOf(["", ...names.map(([, label]) => label)], told)));
  const sure = [["each match against the prediction (NIS)", "nis"], ["each motion over a submap's frames (NEES)", "nees"]]
    .map(([label, name]) => [label, m.consistency?.[name]]).filter(([, c]) => c && c.mean !== null);
  if (sure.length) {
    byId("numbers").append(make("h3", {}, "Squared errors relative to what the mapper expected: 1 is right, more is overconfident"),
      make("div", { class: "scroll" }, tableOf(["", "mean", "95 % band of the mean", "below their 95 % limit", "values"],
        sure.map(([label, c]) => [label, fixed(c.mean, 2), `${fixed(c.low, 2)} to ${fixed(c.high, 2)}`, percent(c.within_95), `${c.samples}`]))));
  }
  const cells = [["observable cells", m.map.observable], ["all cells", m.map.all]].filter(([, s]) => s);
  const rows = [];
  for (const [label, s] of cells) {
    for (const [tolerance, at] of [["0", "tolerance_0"], ["1", null], ["2", "tolerance_2"]]) {
      const walls = at ? s.occupied[at] : s.occupied;
      const free = at ? s.free[at] : s.free;
      rows.push([`${label}, tolerance ${tolerance}`, ...[walls.precision, walls.recall, walls.f1, walls.iou, free.precision, free.recall, free.f1].map((v) => fixed(v, 3))]);
    }
  }
  byId("numbers").append(make("h3", {}, "Map, tolerance in cells"), make("div", { class: "scroll" },
    tableOf(["", "wall precision", "recall", "F1", "IoU", "free precision", "recall", "F1"], rows)));
  byId("numbers").append(make("div", { class: "scroll" }, tableOf(["", "chamfer", "Hausdorff 95 %", "coverage"],
    cells.map(([label, s]) => [label, metres(s.chamfer_m), metres(s.hausdorff95_m), percent(s.coverage)]))));
  const further = furtherMapNumbers(m.map);
  if (further.length) byId("numbers").append(make("h3", {}, "Map, further scores"), make("div", { class: "scroll" }, tableOf(["", "value"], further)));
  const bins = (m.map.calibration?.reliability ?? []).filter((bin) => bin.cells > 0);
  if (bins.length > 1) {
    drawPlot(byId("numbers"), {
      title: "Calibration: share of cells truly occupied against the map's probability; a dot's area is its number of cells", x: bins.map((bin) => bin.mean_prob), xLabel: "probability in the map", yLabel: "share occupied",
      series: [{ label: "truly occupied", values: bins.map((bin) => bin.occupied_share), colour: "est", points: true, onlyPoints: true, weights: bins.map((bin) => bin.cells), weighedBy: "cells", notes: bins.map((bin) => `of ${bin.cells} ${bin.cells === 1 ? "cell" : "cells"}`) }, { label: "ideal", values: bins.map((bin) => bin.mean_prob), colour: "muted", dash: [4, 4] }],
    });
  }
}

initTheme();
headline();
initWarnings();
initMap();
initPlots();
initTimes();
initWorst();
initFrames();
initSamples();
initNumbers();
byId("settings").textContent = RUN.settings;
document.documentElement.dataset.ready = "true";
