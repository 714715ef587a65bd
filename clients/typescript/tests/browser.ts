/** Pages in headless Chromium: a server for their files, and what they have to say in the end. */

import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { join, normalize } from "node:path";
import type { TestContext } from "node:test";

import { folder, ROOT } from "./daemon.js";

/** Where the test script has put the pages and their bundles. */
const PAGES = process.env["CLEARANCE_PAGES"] as string;
const CHROMIUM = process.env["CHROMIUM"] as string;
const TYPES: Record<string, string> = { html: "text/html", js: "text/javascript" };

/** Tells the server what a page has printed, when it says that it is done or has failed. */
const REPORTER = `<script>
  new MutationObserver(() => {
    const { state } = document.body.dataset;
    if (state) fetch("/report", { method: "POST", body: JSON.stringify({ state, text: document.getElementById("text").textContent }) });
  }).observe(document, { subtree: true, attributes: true, attributeFilter: ["data-state"] });
</script>`;

export interface Report {
  state: "done" | "failed";
  text: string;
}

export interface Site {
  origin: string;
  /** Opens a page of the site and waits for its report. */
  visit(page: string): Promise<Report>;
}

/** A server for pages, for `tests/data` as `/data`, and for Chromium to come to. */
export async function site(t: TestContext): Promise<Site> {
  let reported: (report: Report) => void = () => {};
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url ?? "/", "http://localhost");
    if (pathname === "/report") {
      let body = "";
      request.on("data", (part: Buffer) => (body += part.toString()));
      request.on("end", () => {
        response.end();
        reported(JSON.parse(body) as Report);
      });
      return;
    }
    const path = normalize(pathname);
    const file = path.startsWith("/data/") ? join(ROOT, "tests", path) : join(PAGES, path);
    readFile(file).then(
      (content) => {
        const type = TYPES[file.replace(/.*\./, "")] ?? "application/octet-stream";
        response.writeHead(200, { "content-type": type });
        response.end(type === "text/html" ? content.toString().replace("<script", `${REPORTER}<script`) : content);
      },
      () => response.writeHead(404).end(),
    );
  });
  server.listen(0, "127.0.0.1");
  await once(server, "listening");
  t.after(() => {
    server.closeAllConnections();
    server.close();
  });
  const origin = `http://127.0.0.1:${(server.address() as AddressInfo).port}`;
  return {
    origin,
    async visit(page) {
      const profile = await folder(t);
      // Root has no sandbox to go into.
      const flags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", `--user-data-dir=${profile}`];
      const browser = spawn(CHROMIUM, [...flags, `${origin}/${page}`], { stdio: "ignore", detached: true });
      const ended = once(browser, "exit");
      const given = new Promise<Report>((resolve) => (reported = resolve));
      let watchdog: NodeJS.Timeout | undefined;
      const late = new Promise<never>((_, reject) => (watchdog = setTimeout(() => reject(new Error("the page said nothing")), 60_000)));
      try {
        return await Promise.race([given, late, ended.then(() => Promise.reject(new Error("Chromium ended")))]);
      } finally {
        clearTimeout(watchdog);
        // With the helpers it has started.
        if (browser.pid !== undefined && browser.exitCode === null) process.kill(-browser.pid, "SIGKILL");
        await ended.catch(() => {});
      }
    },
  };
}
