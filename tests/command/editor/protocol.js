// Whether messages are what the Debug Adapter Protocol allows, by its own types and TypeScript's compiler.
//
//   node protocol.js FOLDER MODULES
//
// Each message of FOLDER/messages.json becomes a constant of its type, so that a member that is missing, wrong or unknown
// is an error.
'use strict';

const fs = require('node:fs');
const path = require('node:path');

const [folder, modules] = process.argv.slice(2);
const ts = require(path.join(modules, 'typescript'));

const capital = (name) => name[0].toUpperCase() + name.slice(1);

const typeOf = (message) => {
    if (message.type === 'event') return `${capital(message.event)}Event`;
    return message.success ? `${capital(message.command)}Response` : 'ErrorResponse';
};

const messages = JSON.parse(fs.readFileSync(path.join(folder, 'messages.json'), 'utf8'));
const protocol = path.join(modules, '@vscode/debugprotocol').replaceAll('\\', '/');
const lines = messages.map((message, index) =>
    `export const message${index}: DebugProtocol.${typeOf(message)} = ${JSON.stringify(message)};`);
const file = path.join(folder, 'messages.ts');
fs.writeFileSync(file, [`import type { DebugProtocol } from '${protocol}';`, ...lines].join('\n'));

const program = ts.createProgram([file], { strict: true, noEmit: true, types: [], lib: ['lib.es2022.d.ts'], target: ts.ScriptTarget.ES2022,
    module: ts.ModuleKind.CommonJS, moduleResolution: ts.ModuleResolutionKind.Node10 });
const wrong = ts.getPreEmitDiagnostics(program);
for (const { file: where, start, messageText } of wrong) {
    const line = where && where.text.split('\n')[where.getLineAndCharacterOfPosition(start).line];
    console.error(`${ts.flattenDiagnosticMessageText(messageText, '\n')}\n  ${line ?? ''}`);
}
console.log(`${messages.length} messages, ${wrong.length} errors`);
process.exit(wrong.length === 0 && messages.length > 0 ? 0 : 1);
