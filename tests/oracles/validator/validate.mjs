// Prints the error codes that the official validator finds in each file, one line a file.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";

const require = createRequire(join(process.argv[2], "package.json"));
const validator = require("gltf-validator");

for (const path of process.argv.slice(3)) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
    uri: path,
    maxIssues: 0,
    externalResourceFunction: async (uri) =>
      new Uint8Array(readFileSync(join(dirname(path), decodeURIComponent(uri)))),
  });
  const errors = report.issues.messages.filter((m) => m.severity === 0).map((m) => m.code);
  console.log([...new Set(errors)].sort().join(" "));
}
