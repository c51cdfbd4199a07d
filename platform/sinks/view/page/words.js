// Words for the names that messages carry: states, reasons and the reasons of blobs.
export const STATES = ["none", "predicted", "measured", "lost"]; // glint_msgs/Output

const STATE_TEXT = {
  measured: "measured",
  predicted: "predicted",
  lost: "lost",
  never_found: "never found",
  none: "none yet",
};
export const stateText = (state) => STATE_TEXT[state] ?? plain(state);

// The class of a sentence, which has a colour; every other name has the neutral one.
export const stateClass = (state) => (Object.hasOwn(STATE_TEXT, state) ? state : "none");

// kernels/reason.hpp, in the order of its values.
export const REASONS = [
  "none",
  "no_frame_yet",
  "too_few_markers",
  "no_labeling",
  "taken_by_other",
  "degenerate",
  "collinear",
  "bad_fit",
  "frame_late",
  "frame_doubled",
  "frame_invalid",
  "head_pose_missing",
  "too_old",
  "runs_full",
  "blobs_full",
  "search_full",
  "not_prepared",
  "out_of_range",
  "no_reference",
  "overrun_skipped",
  "overrun_held",
  "overrun_predicted",
  "overrun_stopped",
  "tool_changed",
  "imprecise",
  "cloud_full",
  "ambiguous",
];

export const reasonName = (value) => REASONS[value] ?? `reason ${value}`;

export const plain = (name) => name.replaceAll("_", " ").trim();

// One line about a blob of /glint/regions.
export function blobText(blob) {
  const fate =
    blob.marker !== ""
      ? `marker ${blob.marker}`
      : blob.reason !== ""
        ? `refused: ${plain(blob.reason)}`
        : "accepted, of no marker";
  const distance = blob.distance_m > 0 ? `, ${(blob.distance_m * 1000).toFixed(0)} mm away` : "";
  return (
    `${fate}; ${blob.area_px} px large, peak ${blob.peak} counts${distance}, ` +
    `at (${blob.x_px.toFixed(1)}, ${blob.y_px.toFixed(1)}) px`
  );
}

export const blobClass = (blob) =>
  blob.marker !== "" ? "assigned" : blob.reason !== "" ? "refused" : "accepted";

// A sentence for a tool without /glint/explanation.
export function sentenceOfOutput(output) {
  const state = STATES[output.state] ?? "none";
  if (state === "measured")
    return `Tracked: standard deviation ${(output.sigma_position_m * 1e3).toFixed(1)} mm.`;
  if (state === "predicted")
    return `Predicted for ${(output.age_s * 1e3).toFixed(0)} ms: ${plain(reasonName(output.reason))}.`;
  return `Not tracked: ${plain(reasonName(output.reason))}.`;
}
