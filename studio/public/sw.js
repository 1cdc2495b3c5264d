// The page without a network: what was fetched once from its own folder is kept. Documents that `freiform view` serves are
// always asked for anew.
const kName = "freiform-studio-1";
const kServed = /\/(view|document|faces|report)\.json$|\/model\.glb$/;

self.addEventListener("install", (event) => {
    event.waitUntil(caches.open(kName).then((cache) => cache.addAll(["./", "./icon.svg", "./manifest.webmanifest"])).then(() => self.skipWaiting()));
});
self.addEventListener("activate", (event) => {
    event.waitUntil(caches.keys().then((names) => Promise.all(names.filter((name) => name !== kName).map((name) => caches.delete(name)))).then(() => self.clients.claim()));
});
self.addEventListener("fetch", (event) => {
    const url = new URL(event.request.url);
    if (event.request.method !== "GET" || url.origin !== self.location.origin || kServed.test(url.pathname)) return;
    event.respondWith(answer(event.request, /\/assets\//.test(url.pathname)));
});

// Names in assets/ change with their contents, so what is kept is right; all else is asked for first.
async function answer(request, lasting) {
    const cache = await caches.open(kName);
    const kept = await cache.match(request, { ignoreSearch: true });
    if (lasting && kept) return kept;
    try {
        const reply = await fetch(request);
        if (reply.ok) await cache.put(request, reply.clone());
        return reply;
    } catch (error) {
        if (kept) return kept;
        throw error;
    }
}
