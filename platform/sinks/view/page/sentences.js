// One sentence a tool: /glint/explanation, or what /glint/output states where that is absent.
import { sentenceOfOutput, stateClass, stateText, STATES } from "./words.js";

const TOOLS_MAX = 16;

export class Sentences {
  topics = ["/glint/explanation", "/glint/output"];
  #element = document.querySelector("#sentences");
  #lines = new Map(); // by key of #set
  #explained = false;

  reset() {
    this.#lines.clear();
    this.#explained = false;
    this.#element.replaceChildren(line("none", "No message yet.").element);
  }

  // A run sends neither outputs nor explanations before its first frame.
  waitForFrames() {
    this.#element.replaceChildren(
      line(
        "none",
        "Connected, but the run has received no frame yet. " +
          "Check that the source of the frames runs and is connected.",
      ).element,
    );
  }

  show(topic, message, tools) {
    if (topic === "/glint/explanation") {
      if (!this.#explained) this.#clear();
      this.#explained = true;
      this.#set(message.tool, message.tool, message.state, message.text);
    } else if (!this.#explained) {
      this.#set(
        message.tool,
        tools.nameOf(message.tool),
        STATES[message.state] ?? "none",
        sentenceOfOutput(message),
      );
    }
  }

  draw() {}

  #clear() {
    this.#lines.clear();
    this.#element.replaceChildren();
  }

  // key: the tool's name, or its number while the messages do not name it.
  #set(key, tool, state, text) {
    let entry = this.#lines.get(key);
    if (entry === undefined) {
      if (this.#lines.size === TOOLS_MAX) return;
      if (this.#lines.size === 0) this.#element.replaceChildren();
      entry = line(state, text, tool);
      this.#lines.set(key, entry);
      this.#element.append(entry.element);
    }
    // An unchanged text is not set again: a screen reader reads what changes.
    if (entry.text.data !== text) entry.text.data = text;
    if (entry.name.textContent !== tool) entry.element.dataset.tool = entry.name.textContent = tool;
    if (entry.shown === state) return;
    entry.shown = state;
    entry.element.className = `sentence ${stateClass(state)}`;
    entry.state.textContent = stateText(state);
  }
}

function line(state, words, tool = "") {
  const element = document.createElement("p");
  element.className = `sentence ${stateClass(state)}`;
  element.dataset.tool = tool;
  const label = document.createElement("span");
  label.className = "state";
  label.textContent = tool === "" ? "" : stateText(state);
  const name = document.createElement("b");
  name.textContent = tool;
  const text = document.createTextNode(words);
  element.append(label, name, text);
  return { element, state: label, name, text, shown: state };
}
