// Opens the page of a session that is drawn meanwhile, and keeps its picture when asked by a line.
//   node show_session.mjs ADDRESS PICTURE BROWSER
import { once } from "node:events";

import { openPage, sentenceIs, startBrowser } from "./browser.mjs";

const [address, picture, program] = process.argv.slice(2);
const browser = await startBrowser(program);
const { page, until, text } = await openPage(browser, address);
await until("tracked", sentenceIs, "measured", "pen");
console.log("tracked");
await once(process.stdin, "data");
process.stdin.pause();
await until("tracked at the end", sentenceIs, "measured", "pen");
console.log(await text("#sentences"), await text("#scene-text"));
await page.screenshot({ path: picture });
await browser.close();
