// Uses the page at the address of the first argument as a person would; the second is its scene. Ends with 1 where something is wrong.
import { readFileSync, writeFileSync } from "node:fs";
import { execFileSync } from "node:child_process";
import assert from "node:assert/strict";
import puppeteer from "puppeteer-core";

const [url, scene] = process.argv.slice(2);
const pictures = process.env.WATCH_PICTURES;
const browser = await puppeteer.launch({
  executablePath: execFileSync("which", ["chromium"]).toString().trim(), args: ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"],
});
try {
  const page = await browser.newPage();
  page.setDefaultTimeout(120000);
  const wrong = [];
  page.on("console", (message) => { if (["error", "warn"].includes(message.type())) wrong.push(message.text()); });
  page.on("pageerror", (error) => wrong.push(String(error)));
  const own = new URL(url).origin;
  page.on("request", (request) => {
    if (!request.url().startsWith(own) && !request.url().startsWith("data:")) wrong.push(`requests ${request.url()}`);
  });
  const verdict = (word) => page.waitForFunction((word) => document.querySelector("#unit .verdict strong")?.textContent === word, {}, word);
  const axe = async (when) => {
    await page.evaluate(readFileSync(new URL("node_modules/axe-core/axe.min.js", import.meta.url), "utf8"));
    const { violations } = await page.evaluate(() => window.axe.run());
    assert.deepEqual(violations.map(({ id, nodes }) => [id, nodes.slice(0, 3).map((node) => node.html.slice(0, 200))]), [], when);
  };
  const picture = (name) => pictures && page.screenshot({ path: `${pictures}/${name}.png`, fullPage: true });

  await page.setViewport({ width: 1280, height: 900 });
  await page.goto(url);
  await verdict("jammed");
  await page.waitForFunction(() => document.querySelector("#population figure svg"));

  // Plays.
  const frame = () => page.$eval("#unit figure.player", (figure) => Number(figure.dataset.frame));
  await page.click("#unit figure.player button");
  const before = await frame();
  await page.waitForFunction((before) => Number(document.querySelector("#unit figure.player").dataset.frame) !== before, {}, before);
  await page.click("#unit figure.player button");

  // Drags the slider of friction to its left, where the slide runs; the player stays where it was.
  await page.evaluate(() => document.querySelector("#unit figure.player").player.show(33));
  const slider = await page.$('[data-name="friction.coefficient"] input');
  await slider.scrollIntoView();
  const { x, y, width, height } = await slider.boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 6, y + height / 2, { steps: 20 });
  await page.mouse.up();
  await verdict("runs");
  assert.equal(await frame(), 33);
  assert.equal(readFileSync(scene, "utf8").includes("coefficient = 0.3"), true);

  // An error is shown at its line, and goes away.
  const sound = readFileSync(scene, "utf8");
  const place = await page.evaluate(() => { scrollTo(0, 300); return scrollY; });
  writeFileSync(scene, sound.replace("coefficient = 0.3", "coefficient = \"much\""));
  await page.waitForFunction(() => document.querySelector("#error").textContent.includes("coefficient = \"much\""));
  writeFileSync(scene, sound);
  await page.waitForFunction(() => document.querySelector("#error").hidden);
  assert.ok(Math.abs(await page.evaluate(() => scrollY) - place) < 300, "the page has scrolled");

  // A section that was closed stays closed.
  await page.click("#check summary");
  writeFileSync(scene, `${sound}# \n`);
  await page.waitForFunction(() => document.querySelector("#status").textContent.startsWith("computes"));
  await page.waitForFunction(() => document.querySelector("#population figure svg"));
  assert.equal(await page.$eval("#check", (section) => section.open), false);

  // By the keyboard alone: chooses a key, moves its slider, writes it back.
  await page.focus("#choice");
  await page.keyboard.type("slide.mass");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await page.waitForSelector('[data-name="slide.mass"]');
  await page.focus('[data-name="slide.mass"] input');
  for (let i = 0; i < 3; i += 1) await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector("#note").textContent === "slide.mass is written");

  // 200 quick edits leave the last one's result.
  const text = readFileSync(scene, "utf8");
  await page.evaluate(() => {
    const input = document.querySelector('[data-name="friction.coefficient"] input');
    for (let i = 0; i <= 200; i += 1) { input.value = i === 200 ? 0.05 : 0.3 + i / 1000; input.dispatchEvent(new Event("input")); }
  });
  await verdict("runs");
  await new Promise((resolve) => setTimeout(resolve, 1000));
  assert.equal(await page.$eval("#unit .verdict strong", (word) => word.textContent), "runs");
  assert.equal(readFileSync(scene, "utf8"), text);

  assert.notEqual(await page.$eval("#status", (status) => status.textContent), "the program does not answer");
  await axe("light");
  await picture("light");
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
  await axe("dark");
  await picture("dark");
  await page.setViewport({ width: 400, height: 800 });
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "wider than 400 px");
  await axe("narrow");
  await picture("narrow");
  assert.deepEqual(wrong, []);
  console.log("the page was used without an error");
} finally {
  await browser.close();
}
