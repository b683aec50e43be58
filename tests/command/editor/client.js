// A session as an editor has it, by Microsoft's client for tests of debug adapters.
//
//   node client.js COMMAND FOLDER MODULES
//
// FOLDER holds one.c and two.c; all that the adapter sends is written to messages.json there.
'use strict';

const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const { spawn } = require('node:child_process');

const [command, folder, modules] = process.argv.slice(2);
const { DebugClient } = require(path.join(modules, '@vscode/debugadapter-testsupport'));

// An adapter that does not answer ends the test; how long an answer takes is not tested.
setTimeout(() => { console.error('the session does not end'); process.exit(1); }, 300_000).unref();

const messages = [];
const one = path.join(folder, 'one.c');
const two = path.join(folder, 'two.c');

/** The port on which the adapter listens. */
const portOf = (adapter) => new Promise((resolve) => {
    let said = '';
    adapter.stderr.on('data', (data) => {
        said += data;
        const found = /127\.0\.0\.1:(\d+)/.exec(said);
        if (found) resolve(Number(found[1]));
    });
});

/** Lets the board go; the place where it stops next. */
const until = async (client, go) => {
    const stopped = client.waitForEvent('stopped');
    await go;
    const { body } = await stopped;
    const { body: { stackFrames } } = await client.stackTraceRequest({ threadId: body.threadId });
    const [frame] = stackFrames;
    return { ...body, frame, place: frame?.source && `${frame.source.name}:${frame.line}` };
};

const breakpoints = async (client, file, wanted) => {
    const answer = await client.setBreakpointsRequest({ source: { path: file }, breakpoints: wanted });
    return answer.body.breakpoints;
};

const value = async (client, expression, stop) => {
    const answer = await client.evaluateRequest({ expression, frameId: stop.frame.id, context: 'hover' });
    return answer.body.result;
};

const session = async (client) => {
    const begun = client.waitForEvent('initialized');
    await client.initializeRequest({ adapterID: 'cc67', linesStartAt1: true, columnsStartAt1: true, pathFormat: 'path' });
    await client.launchRequest({ programs: [`1:${one}`, `2:${two}`], O: 0 });
    await begun;

    // Breakpoints in two threads, one of them with a condition.
    const refused = await breakpoints(client, one, [{ line: 15, condition: 'count ==' }]);
    assert.equal(refused[0].verified, false);
    assert.ok(refused[0].message);
    const moved = await breakpoints(client, one, [{ line: 4 }]);
    assert.ok(moved[0].line > 4 && /no code/.test(moved[0].message));
    assert.equal((await breakpoints(client, one, [{ line: 15, condition: 'count == 3' }]))[0].verified, true);
    assert.equal((await breakpoints(client, two, [{ line: 9 }]))[0].line, 9);
    await client.setExceptionBreakpointsRequest({ filters: ['traps'] });
    let stop = await until(client, client.configurationDoneRequest());
    assert.deepEqual([stop.reason, stop.threadId, stop.place], ['breakpoint', 2, 'two.c:9']);
    assert.equal((await client.threadsRequest()).body.threads.length, 2);
    await breakpoints(client, two, []);
    stop = await until(client, client.continueRequest({ threadId: 2 }));
    assert.deepEqual([stop.reason, stop.threadId, stop.place], ['breakpoint', 1, 'one.c:15']);
    assert.equal(await value(client, 'count', stop), '3');

    // What changes a variable.
    const { body: { scopes } } = await client.scopesRequest({ frameId: stop.frame.id });
    const globals = scopes.find((scope) => scope.name === 'Variables of the program').variablesReference;
    const { body: { variables } } = await client.variablesRequest({ variablesReference: globals });
    assert.equal(variables.find((variable) => variable.name === 'total').value, '3');
    const info = await client.dataBreakpointInfoRequest({ variablesReference: globals, name: 'total' });
    await client.setDataBreakpointsRequest({ breakpoints: [{ dataId: info.body.dataId }] });
    await breakpoints(client, one, []);
    stop = await until(client, client.continueRequest({ threadId: 1 }));
    assert.equal(stop.reason, 'data breakpoint');
    assert.match(stop.text, /^total: 3 → 6, written by thread 1, main at one\.c:15$/);
    await client.setDataBreakpointsRequest({ breakpoints: [] });

    // Forward over a printf and a move, and back.
    let said = '';
    client.on('output', ({ body }) => { if (body.category === 'stdout') said += body.output; });
    await breakpoints(client, one, [{ line: 18 }]);
    stop = await until(client, client.continueRequest({ threadId: 1 }));
    stop = await until(client, client.nextRequest({ threadId: 1 }));
    stop = await until(client, client.nextRequest({ threadId: 1 }));
    // The line is still on its way to the PC: a stop shows it all the same, and it does not come again after the way back.
    assert.deepEqual([stop.reason, stop.place, said], ['step', 'one.c:20', 'total 10\n']);
    stop = await until(client, client.stepBackRequest({ threadId: 1 }));
    assert.deepEqual([stop.place, await value(client, 'ch0->Dest', stop)], ['one.c:19', '0']);
    stop = await until(client, client.stepBackRequest({ threadId: 1 }));
    assert.equal(stop.place, 'one.c:18');
    await breakpoints(client, one, [{ line: 22 }]);
    stop = await until(client, client.continueRequest({ threadId: 1 }));
    assert.deepEqual([stop.place, await value(client, 'ch0->Dest', stop)], ['one.c:22', '100']);
    assert.equal(said, 'total 10\n');
    await assert.rejects(client.evaluateRequest({ expression: 'nothing', frameId: stop.frame.id }));
    stop = await until(client, client.reverseContinueRequest({ threadId: 1 }));
    assert.match(stop.text ?? '', /beginning/);

    // A trap, with the place where it happened.
    await breakpoints(client, one, []);
    stop = await until(client, client.continueRequest({ threadId: 1 }));
    assert.deepEqual([stop.reason, stop.threadId, stop.place], ['exception', 1, 'one.c:23']);
    const trap = await client.exceptionInfoRequest({ threadId: 1 });
    assert.equal(trap.body.exceptionId, 'trap');
    await client.disassembleRequest({ memoryReference: stop.frame.instructionPointerReference, instructionCount: 4 });
    await client.disconnectRequest();
};

const main = async () => {
    const adapter = spawn(command, ['debug', '--listen', '0'], { cwd: folder });
    const client = new DebugClient('node', '', 'cc67');
    const dispatch = client.dispatch.bind(client);
    client.dispatch = (text) => { messages.push(JSON.parse(text)); dispatch(text); };
    try {
        await client.start(await portOf(adapter));
        await session(client);
        fs.writeFileSync(path.join(folder, 'messages.json'), JSON.stringify(messages));
    } finally {
        adapter.kill();
    }
};

main().then(() => process.exit(0), (error) => {
    console.error(error);
    process.exit(1);
});
