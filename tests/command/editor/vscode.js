// F5 by the rules of Visual Studio Code: what the manifest of the extension says is read, activated and started as the editor does.
//
//   node vscode.js EXTENSION FOLDER PROGRAMS
//
// EXTENSION is the folder of the extension, FOLDER the one of the workspace with one.c, PROGRAMS one that holds the command cc67.
'use strict';

const assert = require('node:assert/strict');
const { spawn } = require('node:child_process');
const fs = require('node:fs');
const Module = require('node:module');
const path = require('node:path');

const [extension, folder, programs] = process.argv.slice(2);
const manifest = JSON.parse(fs.readFileSync(path.join(extension, 'package.json'), 'utf8'));

// An adapter that does not answer ends the test; how long an answer takes is not tested.
setTimeout(() => { console.error('the session does not end'); process.exit(1); }, 300_000).unref();

// The rules of the editor.

/** `ExecutableDebugAdapter.platformAdapterExecutable`: a `program` is a file of the extension, a `runtime` a command. */
const executableOf = (contribution, extensionFolder) => {
    const place = (part) => part && {
        runtime: part.runtime?.startsWith('./') ? path.join(extensionFolder, part.runtime) : part.runtime,
        runtimeArgs: part.runtimeArgs,
        program: part.program && (path.isAbsolute(part.program) ? part.program : path.join(extensionFolder, part.program)),
        args: part.args,
    };
    const system = { win32: contribution.windows ?? contribution.win, darwin: contribution.osx, linux: contribution.linux };
    const { runtime, runtimeArgs, program, args } = { ...place(contribution), ...place(system[process.platform]) };
    if (runtime) return { command: runtime, args: [...(runtimeArgs ?? []), ...(program ? [program] : []), ...(args ?? [])] };
    return program ? { command: program, args: args ?? [] } : undefined;
};

/** `ExecutableDebugAdapter.startSession`: an absolute file must exist, a bare name is left to PATH. */
const start = ({ command, args, options }) => {
    if (path.isAbsolute(command)) assert.ok(fs.existsSync(command), `Debug adapter executable '${command}' does not exist.`);
    return spawn(command, args, { cwd: options?.cwd, env: process.env, stdio: ['pipe', 'pipe', 'inherit'] });
};

/** What the editor puts in place of variables in a configuration. */
const resolved = (configuration, file) => JSON.parse(JSON.stringify(configuration)
    .replaceAll('${file}', JSON.stringify(file).slice(1, -1))
    .replaceAll('${workspaceFolder}', JSON.stringify(folder).slice(1, -1)));

// As much of the editor's interface as the extension uses.

const shown = [];
const registered = {};
const settings = Object.fromEntries(Object.entries(manifest.contributes.configuration.properties)
    .map(([name, { default: value }]) => [name, value]));
const workspaceFolder = { uri: { fsPath: folder }, name: 'machine', index: 0 };
const vscode = {
    DebugAdapterExecutable: class { constructor(command, args, options) { Object.assign(this, { command, args, options }); } },
    ProcessExecution: class { constructor(process, args) { Object.assign(this, { process, args }); } },
    Task: class {
        constructor(definition, scope, name, source, execution, problemMatchers) {
            Object.assign(this, { definition, scope, name, source, execution, problemMatchers });
        }
    },
    TaskGroup: { Build: 'build', Test: 'test' },
    TaskScope: { Workspace: 2 },
    Uri: { file: (fsPath) => ({ fsPath }) },
    commands: { executeCommand: () => {} },
    debug: {
        registerDebugAdapterDescriptorFactory: (type, factory) => { registered.factory = [type, factory]; return {}; },
        registerDebugConfigurationProvider: (type, provider) => { registered.configurations = [type, provider]; return {}; },
    },
    tasks: { registerTaskProvider: (type, provider) => { registered.tasks = [type, provider]; return {}; } },
    window: {
        activeTextEditor: { document: { languageId: 'c' } },
        showErrorMessage: (text, ...choices) => { shown.push([text, ...choices]); return Promise.resolve(undefined); },
    },
    workspace: {
        getConfiguration: (section) => ({ get: (name) => settings[`${section}.${name}`] }),
        workspaceFolders: [workspaceFolder],
    },
};
const load = Module._load;
Module._load = (request, ...rest) => (request === 'vscode' ? vscode : load(request, ...rest));

/** Loads the extension when a session of its type is about to begin, which its manifest must ask for. */
const activate = (type) => {
    const wished = manifest.activationEvents.filter((event) => event === `onDebugResolve:${type}` || event === 'onDebug');
    assert.notDeepEqual(wished, [], 'nothing would activate the extension');
    require(path.join(extension, manifest.main)).activate({ extensionPath: extension, subscriptions: [] });
};

/** The adapter of a session: what the factory says, or else the manifest. */
const descriptor = (type) => {
    const contribution = manifest.contributes.debuggers.find((each) => each.type === type);
    const executable = executableOf(contribution, extension);
    const [of, factory] = registered.factory ?? [];
    return of === type ? factory.createDebugAdapterDescriptor({ workspaceFolder }, executable) : executable;
};

/** A client of the protocol over the pipes of an adapter. */
const connect = (adapter) => {
    const waiting = new Map();
    let sequence = 0;
    let text = Buffer.alloc(0);
    const hear = (message) => {
        const key = message.type === 'response' ? message.request_seq : message.event;
        waiting.get(key)?.(message);
        waiting.delete(key);
    };
    adapter.stdout.on('data', (data) => {
        text = Buffer.concat([text, data]);
        for (;;) {
            const head = text.indexOf('\r\n\r\n');
            const length = head < 0 ? NaN : Number(/Content-Length: (\d+)/.exec(text.subarray(0, head))[1]);
            if (!(text.length >= head + 4 + length)) return;
            hear(JSON.parse(text.subarray(head + 4, head + 4 + length)));
            text = text.subarray(head + 4 + length);
        }
    });
    const wait = (key) => new Promise((resolve) => { waiting.set(key, resolve); });
    const request = async (command, args) => {
        sequence += 1;
        const body = JSON.stringify({ type: 'request', seq: sequence, command, arguments: args });
        const answer = wait(sequence);
        adapter.stdin.write(`Content-Length: ${Buffer.byteLength(body)}\r\n\r\n${body}`);
        const { success, message, body: result } = await answer;
        assert.ok(success, `${command}: ${message}`);
        return result;
    };
    return { request, wait };
};

/** F5 with a breakpoint, a look at variables, and a step back. */
const session = async (configuration) => {
    const adapter = start(descriptor(configuration.type));
    const failed = new Promise((_, reject) => { adapter.once('error', reject); });
    const { request, wait } = connect(adapter);
    const debugged = async () => {
        const begun = wait('initialized');
        await request('initialize', { adapterID: configuration.type, clientID: 'vscode', linesStartAt1: true, columnsStartAt1: true, pathFormat: 'path' });
        await request('launch', configuration);
        await begun;
        const source = { path: path.join(folder, 'one.c') };
        await request('setBreakpoints', { source, breakpoints: [{ line: 15, condition: 'count == 3' }] });
        const next = async (command, args) => {
            const stopped = wait('stopped');
            await request(command, args);
            const { body } = await stopped;
            const { stackFrames: [frame] } = await request('stackTrace', { threadId: body.threadId });
            return { ...body, frame };
        };
        let stop = await next('configurationDone');
        assert.deepEqual([stop.reason, stop.frame.source.name, stop.frame.line], ['breakpoint', 'one.c', 15]);
        const { scopes } = await request('scopes', { frameId: stop.frame.id });
        const { variables } = await request('variables', { variablesReference: scopes.find(({ name }) => name === 'Variables of the program').variablesReference });
        assert.equal(variables.find(({ name }) => name === 'count').value, '3');
        stop = await next('stepBack', { threadId: stop.threadId });
        assert.deepEqual([stop.frame.source.name, stop.frame.line < 15 || stop.frame.line > 15], ['one.c', true]);
        await request('disconnect', {});
    };
    await Promise.race([debugged(), failed]);
    adapter.kill();
};

const main = async () => {
    // The rules by an example: this is why a `program` that is not in the extension's folder never starts.
    assert.equal(executableOf({ program: 'cc67' }, extension).command, path.join(extension, 'cc67'));

    const [{ type, initialConfigurations, configurationSnippets }] = manifest.contributes.debuggers;
    const file = path.join(folder, 'one.c');
    const home = process.env.HOME;

    // By the manifest alone, then by the factory; the command is in PATH.
    process.env.PATH = programs + path.delimiter + process.env.PATH;
    for (const configuration of initialConfigurations) await session(resolved(configuration, file));
    activate(type);
    assert.equal(registered.factory[0], type);
    const [, provider] = registered.configurations;
    const unconfigured = provider.resolveDebugConfiguration(workspaceFolder, {});
    assert.deepEqual(unconfigured, { ...initialConfigurations[0], name: 'Debug' });
    await session(resolved(unconfigured, file));
    assert.deepEqual(configurationSnippets.map(({ body }) => body.request).sort(), ['attach', 'launch', 'launch']);

    // Tasks start the command that was found, and every kind that the manifest names exists.
    const [, tasks] = registered.tasks;
    const offered = tasks.provideTasks();
    assert.deepEqual(offered.map(({ name }) => name), manifest.contributes.taskDefinitions[0].properties.task.enum);
    for (const { execution } of offered) assert.ok(execution.process.startsWith(programs), execution.process);
    assert.deepEqual(tasks.resolveTask({ definition: { type, task: 'run', args: ['two.c'] } }).execution.args, ['run', 'two.c']);

    // A command that is nowhere is said to be missing, with what to do; F5 is not silent.
    process.env.PATH = folder;
    process.env.HOME = process.env.USERPROFILE = folder;
    assert.deepEqual(shown, []);
    assert.throws(() => descriptor(type), /cc67 was not found: there is no "cc67"\. Install it, or set "cc67\.path"/);
    assert.deepEqual(shown[0].slice(1), ['How to Install', 'Open Settings']);

    // The setting is a path, also one in the folder of the workspace.
    const name = process.platform === 'win32' ? 'cc67.exe' : 'cc67';
    settings['cc67.path'] = path.join(programs, name);
    await session(resolved(initialConfigurations[0], file));
    settings['cc67.path'] = `\${workspaceFolder}/${path.relative(folder, programs)}/${name}`;
    await session(resolved(initialConfigurations[0], file));
    process.env.HOME = home;
};

main().then(() => process.exit(0), (error) => {
    console.error(error);
    process.exit(1);
});
