// Puts the player into one page. Run by scripts/player, where the packages are installed:
//
//   node build.mjs SOURCE_FOLDER PACKAGE_FOLDER OUT.html
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { buildSync } from "esbuild";

const [source, packageFolder, out] = process.argv.slice(2);

function bundle(module) {
  const { outputFiles } = buildSync({
    entryPoints: [module],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    define: { "import.meta.url": "location.href" }, // for files that the page does not need
    target: "es2022",
    legalComments: "inline",
    nodePaths: [join(import.meta.dirname ?? ".", "node_modules")],
    logLevel: "warning",
  });
  return outputFiles[0].text;
}

const parts = {
  style: readFileSync(join(source, "page.css"), "utf8"),
  wasm: readFileSync(join(packageFolder, "src", "rlpc.wasm")).toString("base64"),
  worker: bundle(join(packageFolder, "src", "worker.js")),
  page: bundle(join(source, "page.js")),
};
const template = readFileSync(join(source, "page.html"), "utf8");
writeFileSync(out, template.replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]));
