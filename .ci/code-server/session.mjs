// Uses the extension in VS Code as a person does: node session.mjs MODULES ADDRESS FOLDER PICTURES BROWSER COMMAND PLACE
// The command is copied to its place after it has been missed there.
import { copyFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, address, folder, pictures, executablePath, command, place] = process.argv.slice(2);
const { chromium } = (await import(pathToFileURL(resolve(modules, 'playwright-core/index.js')))).default;

const browser = await chromium.launch({
    executablePath,
    args: ['--no-sandbox', '--disable-gpu', '--disable-background-networking', '--disable-component-update', '--no-first-run'],
});
const page = await browser.newPage({ viewport: { width: 1400, height: 1000 } });
page.setDefaultTimeout(20_000);

/** Waits until the part of the page shows a text. */
async function shows(part, text) {
    await page.locator(part).filter({ hasText: text }).first().waitFor();
}

/** Presses keys in the editor of the program. */
async function press(...keys) {
    for (const key of keys) await page.keyboard.press(key);
}

/** Goes to a line of the open program. */
async function goTo(line) {
    await press('Control+g');
    await page.locator('.quick-input-widget .quick-input-box input').first().waitFor();
    await page.keyboard.type(`${line}`);
    await press('Enter');
    await shows('.statusbar', `Ln ${line}`);
}

/** Sets a breakpoint; the key does nothing until the editor has loaded what the extension says of the language. */
async function breakpoint() {
    for (let attempt = 0; attempt < 20; attempt += 1) {
        await press('F9');
        const mark = page.locator('.glyph-margin-widgets [class*=codicon-debug-breakpoint]').first();
        if (await mark.waitFor({ timeout: 2000 }).then(() => true, () => false)) return;
    }
    throw new Error('no breakpoint can be set');
}

const said = (text) => console.log(text);

try {
    await page.goto(`${address}/?folder=${encodeURIComponent(folder)}`);
    await page.locator('.explorer-folders-view').filter({ hasText: 'steps.c' }).waitFor();
    await page.getByText('steps.c').first().dblclick();
    await shows('.editor-container .view-lines', 'KMotionDef');
    await page.locator('.editor-container .view-lines').first().click();
    said('the program is open');

    await goTo(6);
    await breakpoint();
    await press('F5');
    await shows('.monaco-dialog-box', 'cc67 was not found');
    await page.locator('.monaco-dialog-box').getByText('Cancel').click();
    said('F5 without the command: said');

    copyFileSync(command, place);
    await page.locator('.editor-container .view-lines').first().click();
    await press('F5');
    await page.locator('.debug-top-stack-frame-line').first().waitFor();
    await shows('.debug-call-stack', 'square');
    await shows('.debug-call-stack', 'main');
    said('F5: stopped at the breakpoint, with the calls that led there');

    await shows('.debug-variables .monaco-list-row', /area\s*[:=]\s*1/);
    await shows('.debug-variables .monaco-list-row', /side\s*[:=]\s*1/);
    said('locals: as the program computed them');

    await press('F5');
    await shows('.debug-variables .monaco-list-row', /area\s*[:=]\s*4/);
    said('continue: the second time');

    await press('F10');
    await shows('.debug-call-stack', '12:');
    await press('F10');
    await shows('.debug-call-stack', '13:');
    await shows('.debug-variables .monaco-list-row', /sum\s*[:=]\s*5$/);
    said('steps: in the caller, which has the sum');

    const back = page.locator('.debug-toolbar .codicon-debug-step-back');
    await back.click();
    await shows('.debug-call-stack', '12:');
    await back.click();
    await shows('.debug-call-stack', '13:');
    await shows('.debug-variables .monaco-list-row', /sum\s*[:=]\s*1$/);
    said('steps back: before the call, with the values of that time');

    await page.locator('.debug-toolbar .codicon-debug-reverse-continue').click();
    await shows('.debug-variables .monaco-list-row', /area\s*[:=]\s*1$/);
    said('reverse: at the breakpoint of before');

    await goTo(6);
    await press('F9', 'F5');
    await shows('.repl', 'sum 30');
    said('the end: the console of the program');
} catch (error) {
    await page.screenshot({ path: join(pictures, 'failed.png') });
    console.error(await page.locator('.debug-variables').allInnerTexts(), await page.locator('.debug-call-stack').allInnerTexts());
    console.error(`${error}`);
    process.exitCode = 1;
} finally {
    await browser.close();
}
