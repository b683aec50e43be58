// Finds the command, starts its debug adapter, and offers tasks. All else is in the manifest.
'use strict';

const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const vscode = require('vscode');

/** The command that the setting `cc67.path` names, in the words of a folder of the workspace. */
function wanted(folder) {
    const setting = vscode.workspace.getConfiguration('cc67', folder).get('path') || 'cc67';
    const root = folder ? folder.uri.fsPath : '';
    return setting.replaceAll('${workspaceFolder}', root).replace(/^~(?=[/\\])/, os.homedir());
}

/** Whether a file can be started. */
function isExecutable(file) {
    try {
        fs.accessSync(file, fs.constants.X_OK);
        return fs.statSync(file).isFile();
    } catch {
        return false;
    }
}

/**
 * The file of a command: a name with a separator is a path, any other one is searched for in PATH and where cargo and pip put
 * commands, as an editor that was not started in a terminal may have a short PATH. `undefined` if there is none.
 */
function find(command) {
    const suffixes = process.platform === 'win32' ? ['.exe', '.cmd', ''] : [''];
    const folders = path.basename(command) === command
        ? [...(process.env.PATH || '').split(path.delimiter), path.join(os.homedir(), '.cargo/bin'), path.join(os.homedir(), '.local/bin')]
        : [''];
    const files = folders.flatMap((folder) => suffixes.map((suffix) => path.join(folder, command + suffix)));
    return files.find(isExecutable);
}

/** Says that the command is missing, and offers what helps. */
function complain(command, extension) {
    const text = `cc67 was not found: there is no "${command}". Install it, or set "cc67.path" to where it is.`;
    vscode.window.showErrorMessage(text, 'How to Install', 'Open Settings').then((choice) => {
        if (choice === 'Open Settings') vscode.commands.executeCommand('workbench.action.openSettings', 'cc67.path');
        if (choice === 'How to Install') {
            vscode.commands.executeCommand('markdown.showPreview', vscode.Uri.file(path.join(extension, 'README.md')));
        }
    });
    return text;
}

/** The adapter of a session: the command that was found, with the arguments of the manifest. */
function descriptorFactory(extension) {
    return {
        createDebugAdapterDescriptor(session, executable) {
            const command = wanted(session.workspaceFolder);
            const file = find(command);
            // VS Code shows the message of an error as the reason why there is no session.
            if (!file) throw new Error(complain(command, extension));
            const folder = session.workspaceFolder ? { cwd: session.workspaceFolder.uri.fsPath } : undefined;
            return new vscode.DebugAdapterExecutable(file, executable.args, folder);
        },
    };
}

/** F5 in a folder without launch.json debugs the open program. */
const configurationProvider = {
    resolveDebugConfiguration(_folder, configuration) {
        if (configuration.type || configuration.request) return configuration;
        const editor = vscode.window.activeTextEditor;
        if (!editor || editor.document.languageId !== 'c') {
            vscode.window.showErrorMessage('Open a C program to debug it with cc67.');
            return undefined;
        }
        return { type: 'cc67', request: 'launch', name: 'Debug', programs: ['1:${file}'], O: 0 };
    },
};

/** The tasks for the open program: name, arguments, group. */
const TASKS = [
    ['check', ['check', '--message-format', 'short', '${file}'], 'Build'],
    ['run', ['run', '${file}'], undefined],
    ['plot', ['run', '--plot', '${fileDirname}/${fileBasenameNoExtension}.html', '${file}'], undefined],
    ['test', ['test', '.'], 'Test'],
];

/** A task of the kind `definition`; `undefined` if there is no such task. */
function task(definition, scope) {
    const row = TASKS.find(([name]) => name === definition.task);
    if (!row) return undefined;
    const [name, args, group] = row;
    const folder = typeof scope === 'object' ? scope : vscode.workspace.workspaceFolders?.[0];
    const command = wanted(folder);
    const run = new vscode.ProcessExecution(find(command) || command, definition.args ? [name, ...definition.args] : args);
    const made = new vscode.Task(definition, scope ?? vscode.TaskScope.Workspace, name, 'cc67', run, '$cc67');
    if (group) made.group = vscode.TaskGroup[group];
    return made;
}

const taskProvider = {
    provideTasks: () => TASKS.map(([name]) => task({ type: 'cc67', task: name }, vscode.TaskScope.Workspace)),
    resolveTask: (asked) => task(asked.definition, asked.scope),
};

exports.activate = (context) => {
    context.subscriptions.push(
        vscode.debug.registerDebugAdapterDescriptorFactory('cc67', descriptorFactory(context.extensionPath)),
        vscode.debug.registerDebugConfigurationProvider('cc67', configurationProvider),
        vscode.tasks.registerTaskProvider('cc67', taskProvider),
    );
};
