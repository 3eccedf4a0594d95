// Builds the one script of the page: `npm ci && npm run build`.
// Into its first line goes the digest of all that it is made of, by which a test sees that it is
// not stale; ends of line do not count.

import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const OUT = "../drawing/page/data/viewer.js";
const LICENSED = ["three", "uplot"];

const text = (path) => readFileSync(path, "utf-8").replace(/\r\n/g, "\n");
const inputs = ["build.mjs", "package.json", "package-lock.json", ...readdirSync("src").map((name) => `src/${name}`)];
const digest = createHash("sha256");
for (const path of inputs.sort()) digest.update(`${path}\0${text(path)}\0`);

const licences = LICENSED.map((name) => {
  const { version } = JSON.parse(text(`node_modules/${name}/package.json`));
  return `${name} ${version}\n\n${text(`node_modules/${name}/LICENSE`).trim()}`;
});
const banner = `/*! flyby viewer, built from viewer/ sha256:${digest.digest("hex")}

${licences.join("\n\n")}
*/`;

const made = await build({
  entryPoints: ["src/main.js"],
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
  loader: { ".css": "text" },
  write: false,
});
const script = made.outputFiles[0].text.replace(/<\/script/gi, "<\\/script").replace(/<!--/g, "<\\!--");
writeFileSync(OUT, `${banner}\n${script}`);
console.log(`${OUT}: ${Math.round((banner.length + script.length) / 1000)} kB`);
