// Uses `deburr view` in a browser as a person does: headless Chromium, driven by puppeteer-core.
//
//   tests/browser/view_test.sh PROGRAM [FOLDER]      FOLDER gets pictures of the page
//
// Times are printed but never make a test fail, as the machine may be busy.
import assert from 'node:assert/strict';
import {spawn, execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, writeFileSync, rmSync, mkdirSync, existsSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';

// Imported from the current folder, where it is installed, and not from this file's.
const puppeteer = createRequire(process.cwd() + '/')('puppeteer-core');

const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
const [program, shots] = process.argv.slice(2).map(path => resolve(path));
const folder = mkdtempSync(join(tmpdir(), 'deburr-browser-'));
const browser_path = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find(existsSync);
const figures = [];
const say = (what, value) => { figures.push([what, value]); console.log(`${what}: ${value}`); };
const pause = ms => new Promise(done => setTimeout(done, ms));
const median = all => [...all].sort((a, b) => a - b)[all.length >> 1];

const solid = radius => `local h = param("height", 1)
return {
  camera = { eye = {3, 2, 4}, target = {0.5, 0.5, 0.5}, fov = 30 },
  image = { width = 240, height = 160, spp = 4 },
  solids = { rounded(${radius}, box({0, 0, 0}, {1, h, 1})):material(plastic{ color = {0.8, 0.3, 0.2} }):name("block") },
}
`;

const children = [];

// Starts the program; `address` is what it prints, and `begin` the time of the start.
async function view(file, ...more) {
  const begin = performance.now();
  const child = spawn(program, ['view', file, ...more], {stdio: ['ignore', 'pipe', 'inherit']});
  children.push(child);
  const address = await new Promise((done, fail) => {
    let text = '';
    child.stdout.on('data', data => { text += data; if (text.includes('\n')) done(text.trim()); });
    child.on('exit', code => fail(new Error(`deburr view ended with ${code}`)));
  });
  return {child, address, begin};
}

// Opens a tab that records time and width of every picture that its page paints, and the page's errors.
async function open(browser, address, size = {width: 1000, height: 700}) {
  const page = await browser.newPage();
  await page.setViewport(size);
  const wrong = [];
  page.on('pageerror', error => wrong.push(String(error)));
  page.on('console', message => { if (message.type() === 'error') wrong.push(message.text()); });
  await page.evaluateOnNewDocument(() => {
    window.painted = [];
    const put = CanvasRenderingContext2D.prototype.putImageData;
    CanvasRenderingContext2D.prototype.putImageData = function (...all) {
      put.apply(this, all);
      window.painted.push({at: performance.timeOrigin + performance.now(), width: all[0].width});
    };
  });
  await page.goto(address, {waitUntil: 'domcontentloaded'});
  return {page, wrong};
}
// Starts the program with a new scene file of this name and opens a tab that shows it.
async function begin(browser, name, more = [], size = undefined) {
  const file = join(folder, name);
  writeFileSync(file, solid(0.1));
  const {child, address} = await view(file, ...more);
  return {file, child, address, ...await open(browser, address, size)};
}
const until = (page, test, ...more) => page.waitForFunction(test, {timeout: 30000, polling: 20}, ...more);
const finished = page => until(page, () => document.getElementById('words').textContent.startsWith('Finished'));
const pixels = page => page.evaluate(() => {
  const c = document.getElementById('picture');
  return Array.from(c.getContext('2d').getImageData(0, 0, c.width, c.height).data).join();
});
const painted = page => page.evaluate(() => window.painted.length);
const picture_after = (page, count) => until(page, n => window.painted.length > n, count);
// Waits up to ten seconds until the page shows these pixels.
async function shows(page, wanted) {
  for (let k = 0; k < 100; ++k, await pause(100)) if (await pixels(page) === wanted) return;
  assert.fail('other pixels were expected');
}
const place = async page => { const box = await (await page.$('#picture')).boundingBox(); return {x: box.x + box.width / 2, y: box.y + box.height / 2}; };
const shot = async (page, name) => { if (shots) { mkdirSync(shots, {recursive: true}); await page.screenshot({path: join(shots, name + '.png')}); } };

// Pixels of a PNG file as the browser decodes them.
const decoded = (browser, file) => browser.newPage().then(async page => {
  const text = await page.evaluate(async base64 => {
    const bytes = Uint8Array.from(atob(base64), c => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], {type: 'image/png'}), {colorSpaceConversion: 'none'});
    const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    return Array.from(context.getImageData(0, 0, image.width, image.height).data).join();
  }, readFileSync(file).toString('base64'));
  await page.close();
  return text;
});

// Turns the scene with the mouse for this time; returns the number of pictures painted per second.
async function drag(page, seconds) {
  const {x, y} = await place(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  const before = await painted(page), begin = performance.now();
  for (let i = 1; performance.now() - begin < 1000 * seconds; ++i) {
    await page.mouse.move(x + 80 * Math.sin(i / 9), y + 30 * Math.sin(i / 7));
    await pause(8);
  }
  const rate = (await painted(page) - before) / ((performance.now() - begin) / 1000);
  await page.mouse.up();
  return rate;
}

const tests = {
  async 'the picture comes, and ends as the bytes of render'(browser) {
    const {file, child, page, wrong} = await begin(browser, 'block.lua');
    await finished(page);
    execFileSync(program, ['render', file, '-o', join(folder, 'block.png'), '-q']);
    await shows(page, await decoded(browser, join(folder, 'block.png')));
    assert.equal(await page.title(), 'block.lua – Deburr');
    await shot(page, 'block');

    // A click and the keyboard both tell which solid is there.
    const {x, y} = await place(page);
    await page.mouse.click(x, y);
    await until(page, () => document.getElementById('surface').textContent.includes('block'));
    const surface = await page.$eval('#surface', e => e.textContent);
    for (const part of ['plastic', 'block.lua:', '0.1', 'position', 'normal']) assert.ok(surface.includes(part), surface);
    await page.mouse.click(x - 115, y - 75);
    await until(page, () => document.getElementById('surface').textContent.includes('Nothing'));
    await page.focus('#picture');
    await page.keyboard.press('Enter');
    await until(page, () => document.getElementById('surface').textContent.includes('block'));

    // Keys turn the camera, look along an axis, and go back to the scene's camera.
    const first = await pixels(page);
    for (const key of ['ArrowLeft', 'ArrowUp', '+', '1', '3', '7', '9']) {
      const count = await painted(page), before = await pixels(page);
      await page.keyboard.press(key);
      await picture_after(page, count);
      await finished(page);
      assert.notEqual(await pixels(page), before, key);
    }
    await page.keyboard.press('0');
    await shows(page, first);

    // The page shows the mesh's edges, changes a parameter, copies the camera as Lua, and serves the STL that mesh
    // makes.
    let count = await painted(page);
    await page.click('#wires');
    await picture_after(page, count);
    await finished(page);
    assert.equal(await page.$eval('#wires', e => e.getAttribute('aria-pressed')), 'true');
    assert.notEqual(await pixels(page), first);
    await shot(page, 'mesh');
    await page.click('#wires');
    await shows(page, first);
    count = await painted(page);
    await page.$eval('#of-height', e => { e.value = '0.4'; e.dispatchEvent(new Event('change')); });
    await picture_after(page, count);
    await finished(page);
    assert.notEqual(await pixels(page), first);
    await page.click('#copy');
    await until(page, () => document.getElementById('copied').textContent !== '');
    const stl = await page.evaluate(async () => Array.from(new Uint8Array(await (await fetch('picture.stl')).arrayBuffer())).join());
    execFileSync(program, ['mesh', file, '-D', 'height=0.4', '-o', join(folder, 'block.stl'), '-q']);
    assert.equal(stl, Array.from(readFileSync(join(folder, 'block.stl'))).join());

    // Every control has a name, and changes are announced.
    const named = await page.$$eval('button, input, a, canvas', all => all.map(e => e.getAttribute('aria-label') || e.textContent || document.querySelector(`label[for="${e.id}"]`)?.textContent));
    assert.ok(named.every(Boolean), named.join());
    assert.deepEqual(await page.$$eval('[role=status], [role=alert], [aria-live]', all => all.map(e => e.id)), ['error', 'words', 'surface', 'copied']);
    assert.equal(await page.$eval('#picture', e => e.getAttribute('role')), 'application');
    assert.equal(await page.$eval('#picture', e => e.getAttribute('aria-label')), 'Picture of block.lua');

    // When the program has ended the page says so.
    child.kill('SIGINT');
    await until(page, () => document.getElementById('words').textContent.includes('has ended'));
    assert.deepEqual(wrong.filter(text => !/ERR_|Failed to load/.test(text)), []);
    await page.close();
  },

  async 'the file is edited, broken, mended, deleted and written again'(browser) {
    const {file, child, page} = await begin(browser, 'edited.lua');
    await finished(page);
    const first = await pixels(page);
    const times = [];
    for (const radius of [0.2, 0.3, 0.15, 0.25, 0.35]) {
      const count = await painted(page), begin = Date.now();
      writeFileSync(file, solid(radius));
      await picture_after(page, count);
      times.push(await page.evaluate(n => window.painted[n].at, count) - begin);
      await finished(page);
    }
    say('from an edit to the next picture, 240 × 160, ms', median(times).toFixed(0));
    assert.notEqual(await pixels(page), first);
    const last = await pixels(page);
    writeFileSync(file, solid(0.2) + 'oops(');
    await until(page, () => !document.getElementById('error').hidden);
    assert.match(await page.$eval('#error', e => e.textContent), /edited\.lua:\d+/);
    assert.equal(await pixels(page), last);
    await shot(page, 'error');
    rmSync(file);
    await pause(300);
    assert.equal(await pixels(page), last);
    writeFileSync(file, solid(0.1));
    await until(page, () => document.getElementById('error').hidden);
    await shows(page, first);
    child.kill('SIGINT');
    await page.close();
  },

  async 'two pages see the same, and one may go'(browser) {
    const {child, address, page: one} = await begin(browser, 'two.lua');
    const other = (await open(browser, address)).page;
    await finished(one);
    await finished(other);
    await one.bringToFront();
    await drag(one, 0.3);
    await finished(one);
    await one.close();
    await other.bringToFront();
    await finished(other);
    const count = await painted(other);
    await other.focus('#picture');
    await other.keyboard.press('ArrowRight');
    await picture_after(other, count);
    child.kill('SIGINT');
    await other.close();
  },

  async 'a phone, the dark, and a slow line'(browser) {
    const {child, page} = await begin(browser, 'phone.lua', ['--size', '960x640'], {width: 390, height: 844, hasTouch: true, isMobile: true, deviceScaleFactor: 2});
    await finished(page);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
    await shot(page, 'phone');
    const light = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    await page.emulateMediaFeatures([{name: 'prefers-color-scheme', value: 'dark'}]);
    assert.notEqual(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), light);
    await shot(page, 'phone-dark');
    await page.setViewport({width: 1300, height: 800});
    // At 10 Mbit/s an uncompressed frame takes two seconds.
    await page.emulateNetworkConditions({download: 1.25e6, upload: 1.25e6, latency: 20});
    await drag(page, 4);
    say('pictures a second in a drag, 960 × 640 by 10 Mbit a second', (await drag(page, 3)).toFixed(1));
    await finished(page);
    child.kill('SIGINT');
    await page.close();
  },

  // Measures the scenes that the README shows.
  async 'large scenes are quick'(browser) {
    for (const [name, size] of [['csg_examples', '600x380'], ['variable_rounding', '600x380'], ['csg_examples', '1920x1080']]) {
      const at = `${name}, ${size.replace('x', ' × ')}`, file = join(folder, name + '.lua');
      const text = readFileSync(join(root, 'scenes', name + '.lua'), 'utf8');
      writeFileSync(file, text);
      const {child, address, begin} = await view(file, '--size', size, '--spp', '64');
      const {page, wrong} = await open(browser, address, {width: 2240, height: 1200});
      await picture_after(page, 0);
      const first = await page.evaluate(() => window.painted[0].at) - (performance.timeOrigin + begin);
      say(`from the command to the first picture, the browser being open, ${at}, ms`, first.toFixed(0));
      await pause(500);
      say(`pictures a second in a drag, ${at}`, (await drag(page, 3)).toFixed(1));
      const times = [];
      for (let i = 0; i < 5; ++i) {
        const count = await painted(page), at = Date.now();
        writeFileSync(file, text + '\n'.repeat(i + 1));
        await picture_after(page, count);
        times.push(await page.evaluate(n => window.painted[n].at, count) - at);
        await pause(200);
      }
      say(`from an edit to the next picture, ${at}, ms`, median(times).toFixed(0));
      if (size === '1920x1080') await shot(page, 'large');
      assert.deepEqual(wrong, []);
      child.kill('SIGINT');
      await page.close();
    }
  },
};

// As root, for instance in a container, Chromium runs only without its sandbox.
const browser = await puppeteer.launch({executablePath: browser_path, headless: true, args: ['--no-sandbox', '--disable-gpu', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run']});
let failed = 0;
try {
  for (const [name, test] of Object.entries(tests)) {
    try {
      await test(browser);
      console.log(`passed: ${name}`);
    } catch (error) {
      ++failed;
      for (const page of (await browser.pages()).slice(1)) await page.close();
      console.error(`failed: ${name}\n${error.stack}`);
    }
  }
} finally {
  for (const child of children) child.kill('SIGKILL');
  await browser.close();
  rmSync(folder, {recursive: true, force: true});
}
console.log(failed ? `${failed} of ${Object.keys(tests).length} tests failed` : `all ${Object.keys(tests).length} tests passed`);
process.exit(failed ? 1 : 0);
