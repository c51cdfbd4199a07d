// One sentence a tool: /glint/explanation, or what /glint/output states where that is absent.
import { sentenceOfOutput, stateClass, stateText, STATES } from "./words.js";

const TOOLS_MAX = 16;

export class Sentences {
  topics = ["/glint/explanation", "/glint/output"];
  #element = document.querySelector("#sentences");
  #lines = new Map();  // by tool
  #explained = false;

  reset() {
    this.#lines.clear();
    this.#explained = false;
    this.#element.replaceChildren(line("none", "No message yet.").element);
  }

  show(topic, message, tools) {
    if (topic === "/glint/explanation") {
      if (!this.#explained) this.#clear();
      this.#explained = true;
      this.#set(message.tool, message.state, message.text);
    } else if (!this.#explained) {
      this.#set(tools.nameOf(message.tool), STATES[message.state] ?? "none", sentenceOfOutput(message));
    }
  }

  draw() {}

  #clear() {
    this.#lines.clear();
    this.#element.replaceChildren();
  }

  #set(tool, state, text) {
    let entry = this.#lines.get(tool);
    if (entry === undefined) {
      if (this.#lines.size === TOOLS_MAX) return;
      if (this.#lines.size === 0) this.#element.replaceChildren();
      entry = line(state, text, tool);
      this.#lines.set(tool, entry);
      this.#element.append(entry.element);
    }
    // An unchanged text is not set again: a screen reader reads what changes.
    if (entry.text.data !== text) entry.text.data = text;
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
  return { element, state: label, text, shown: state };
}
