// The page of Glint's live view: messages of the run, or of an opened recording, to the panels.
import { Charts } from "./charts.js";
import { Decoder } from "./decoding.js";
import { Freshness } from "./freshness.js";
import { LiveSource } from "./live_source.js";
import { Picture } from "./picture.js";
import { Playback } from "./playback.js";
import { RecordButton } from "./record_button.js";
import { RecordingFile } from "./recording_file.js";
import { SceneView } from "./scene.js";
import { Sentences } from "./sentences.js";
import { Tools } from "./tools.js";

const DRAW_MS = 66; // between pictures; longer on a slow computer, which then still receives
const CHARTS_MS = 250;
const IDLE_SHARE = 3; // times what drawing takes

const status = document.querySelector("#source");
const live = document.querySelector("#live");
const fileInput = document.querySelector("#file");
const drop = document.querySelector("#drop");

const decoder = new Decoder();
const freshness = new Freshness();
const sentences = new Sentences(),
  picture = new Picture(),
  scene = new SceneView(),
  charts = new Charts();
const recordButton = new RecordButton();
const playback = new Playback();
let tools = new Tools();
let source = null;

function reset() {
  tools = new Tools();
  for (const panel of [sentences, picture, scene, charts]) panel.reset();
}

function show(channel, bytes) {
  const panels = [sentences, picture, charts].filter(({ topics }) =>
    topics.includes(channel.topic),
  );
  if (scene.wants(channel.topic, tools)) panels.push(scene);
  if (panels.length === 0) return;
  const message = decoder.decode(channel, bytes);
  if (message === null) return;
  if (channel.topic === "/tf")
    for (const transform of message.transforms) tools.transform(transform);
  for (const panel of panels) panel.show(channel.topic, message, tools);
}

function openRun() {
  playback.close();
  reset();
  scene.aimAgain();
  live.hidden = true;
  recordButton.disabled = false;
  freshness.watch(true);
  if (location.protocol === "file:") {
    status.textContent = "No run: this page is a file. Open a recording.";
    return;
  }
  source = new LiveSource(`ws://${location.host}/`, {
    connected() {
      reset(); // another run may have started on this port
      freshness.watch(true);
      sentences.waitForFrames();
      status.textContent = `Live from ${location.host}`;
    },
    disconnected() {
      status.textContent = `No run at ${location.host}: connecting again each second`;
    },
    channel(channel) {
      tools.channel(channel);
    },
    message(channel, time, bytes) {
      freshness.received(channel.topic);
      recordButton.message(channel, time, bytes);
      show(channel, bytes);
    },
  });
}

async function openRecording(file) {
  let recording;
  try {
    recording = await RecordingFile.open(file);
  } catch (error) {
    status.textContent = error.message;
    return;
  }
  source?.close();
  source = null;
  await recordButton.stop();
  recordButton.disabled = true;
  live.hidden = false;
  freshness.watch(false);
  status.textContent = `Recording ${recording.name}`;
  scene.aimAgain();
  playback.open(recording, {
    reset() {
      reset();
      for (const channel of recording.channels.values()) tools.channel(channel);
    },
    message: (channel, time, bytes) => show(channel, bytes),
    drawn() {
      for (const panel of [picture, scene, charts]) panel.draw();
    },
  });
}

fileInput.addEventListener("change", () => {
  if (fileInput.files.length > 0) openRecording(fileInput.files[0]);
  fileInput.value = "";
});
live.addEventListener("click", openRun);
addEventListener("dragover", (event) => {
  event.preventDefault();
  drop.hidden = false;
});
addEventListener("dragleave", (event) => {
  if (event.relatedTarget === null) drop.hidden = true;
});
addEventListener("drop", (event) => {
  event.preventDefault();
  drop.hidden = true;
  if (event.dataTransfer.files.length > 0) openRecording(event.dataTransfer.files[0]);
});

function repeat(draw, period_ms) {
  const begin = performance.now();
  draw();
  setTimeout(
    () => repeat(draw, period_ms),
    Math.max(period_ms, IDLE_SHARE * (performance.now() - begin)),
  );
}
repeat(() => {
  picture.draw();
  scene.draw();
}, DRAW_MS);
repeat(() => charts.draw(), CHARTS_MS);
openRun();
