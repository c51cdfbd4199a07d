// Bundles the page into one HTML file, and that into a C++ include.
//   node bundle.mjs PAGE_FOLDER WORK_FOLDER
// Writes WORK_FOLDER/page.html and WORK_FOLDER/view_page.inc. Runs in WORK_FOLDER, which holds the
// packages; the sources stay where they are.
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { build } from "esbuild";

const [sources, work] = process.argv.slice(2);
const PART_BYTES_MAX = 16 << 10;

const bundled = (file) =>
  build({
    entryPoints: [join(sources, file)],
    bundle: true,
    minify: true,
    charset: "ascii",
    legalComments: "inline",
    target: "es2022",
    nodePaths: [join(work, "node_modules")],
    write: false,
    logLevel: "error",
  }).then((result) => result.outputFiles[0].text);

const script = (await bundled("main.js")).replaceAll("</script", "<\\/script");
const style = await bundled("style.css");
const frame = readFileSync(join(sources, "index.html"), "utf8");
const page = frame
  .replace("<!-- style -->", () => `<style>${style}</style>`)
  .replace("<!-- script -->", () => `<script type="module">${script}</script>`);

// The script is admitted by its sum; 'self' is the WebSocket of the server that sent the page.
const sum = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const policy = [
  "default-src 'none'",
  `script-src ${sum(script)}`,
  `style-src ${sum(style)}`,
  "connect-src 'self'",
  "img-src data:",
  "base-uri 'none'",
  "form-action 'none'",
  "frame-ancestors 'none'",
].join("; ");

const bytes = Buffer.from(page);
const parts = [];
for (let at = 0; at < bytes.length; at += PART_BYTES_MAX) {
  parts.push(bytes.toString("latin1", at, at + PART_BYTES_MAX));
}
const quoted = (text) => `"${[...text].map(escaped).join("")}"`;
// Of other bytes than printable ASCII, three octal digits: more digits cannot follow.
function escaped(character) {
  if (character === "\n") return "\\n";
  if (character === '"' || character === "\\" || character === "?") return `\\${character}`;
  const code = character.charCodeAt(0);
  return code >= 32 && code < 127 ? character : `\\${code.toString(8).padStart(3, "0")}`;
}

writeFileSync(join(work, "page.html"), page);
writeFileSync(
  join(work, "view_page.inc"),
  `constexpr const char* k_page_type = "text/html; charset=utf-8";
constexpr std::string_view k_page_policy = ${quoted(policy)};
constexpr std::string_view k_page_parts[] = {
${parts.map((part) => `    ${quoted(part)}sv,`).join("\n")}
};
`,
);
