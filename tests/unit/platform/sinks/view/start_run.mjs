// Starts runs of glint with a live view.
import { spawn } from "node:child_process";
import { join } from "node:path";

// Starts glint with a live view; `address` resolves once it listens. With --keys its standard input
// is a terminal, to which `process.stdin` writes.
export function startView(glint, ...options) {
  const run = spawn(...commandOf([glint, ...options]));
  let output = "";
  const ended = new Promise((resolve) => run.on("exit", resolve));
  const address = new Promise((resolve, reject) => {
    run.stdout.on("data", (text) => {
      output += text;
      const found = output.match(/^view +(ws:\S+),/m);
      if (found) resolve(found[1]);
    });
    ended.then((code) => reject(new Error(`glint ended with ${code}: ${output}`)));
  });
  run.stderr.on("data", (text) => (output += text));
  return { ended, address, process: run, output: () => output };
}

// Returns a function that starts a run, with the common options and its own.
export const runStarter = (glint, folder, ...common) => (port, name, ...options) =>
  startView(glint, "run", "--no-dds", "--view", port, "--out", join(folder, name),
    "--json", join(folder, `${name}.json`), ...common, ...options);

// --keys reads a terminal: util-linux's script makes one.
function commandOf(command) {
  if (!command.includes("--keys")) return [command[0], command.slice(1)];
  const quoted = command.map((word) => `'${word.replaceAll("'", "'\\''")}'`).join(" ");
  return ["script", ["--quiet", "--flush", "--return", "--command", quoted, "/dev/null"]];
}

// A busy machine renders too slowly for a live run, or writes too slowly; the view shows what is
// recorded.
export const acceptable = (code, output) =>
  code === 0 || (code === 1 && /source too slow|messages dropped, queue full/.test(output));
