// Shared by the parts of a run's page: its data and the selection.
"use strict";
const RUN = JSON.parse(byId("data").textContent);
const frames = RUN.frames;
const frameCount = frames.frame.length;
// The map is light in both themes, so what is drawn on it keeps its colours.
const MAP_COLOURS = { truth: "#009e73", slam: "#d98c00", online: "#56b4e9", est: "#0072b2", scan: "#d4002a", missed: "#d55e00", invented: "#cc79a7" };
// In the other frames SLAM was lost: they are not mapped, and their times and beams are meaningless.
const hasPose = (i) => RUN.paths.slam.x[i] !== null;
const whereMapped = (values) => values.map((v, i) => (hasPose(i) ? v : null));
let currentFrame = 0;
let currentLayer = "estimate";

const LAYERS = [
  ["estimate", "Estimate"], ["truth", "Truth"], ["difference", "Difference"],
  ["observable", "Observable"],
].filter(([name]) => RUN.map.layers[name]);
const INPUT_LABEL = `${RUN.input_poses[0].toUpperCase()}${RUN.input_poses.slice(1)}, ${RUN.prior_scans ? "placed where the run begins" : "as it came in"}`;
const PATHS = [
  ["truth", "Truth", "truth"], ["slam", INPUT_LABEL, "slam"],
  ["online", "Estimate at the time", "online"], ["est", "Estimate at the end", "est"],
].filter(([name]) => RUN.paths[name]);
const shownPaths = new Set(["scan", ...PATHS.map(([name]) => name).filter((name) => name !== "online")]);
