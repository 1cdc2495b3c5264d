// What is being edited outlives a crash of the browser: every settled state goes into IndexedDB, the newest wins. Each
// window writes under a key of its own, which it holds by a lock as long as it lives, so windows do not overwrite each
// other. A window that is opened takes what it had before (a reload), or else the newest drawing whose window is gone, or
// else a copy of the newest under a new key. So every drawing comes back, and there are never more than there were windows.

const kBase = "freiform", kStore = "documents", kFirst = "now", kWindow = "freiform.window";
/** Beside what is kept under a key: when. */
const timeOf = (key: string): string => `at ${key}`;
/** Milliseconds for a window that loads anew to let go of what it held. */
const kPatience = 500;
/** As many stay where the browser has no locks, without which nobody knows which windows are gone. */
const kMost = 20;

interface Kept { readonly key: string; readonly text: string; readonly time: number }

function open(): Promise<IDBDatabase> {
    return new Promise((resolve, reject) => {
        const request = indexedDB.open(kBase, 1);
        request.onupgradeneeded = () => { request.result.createObjectStore(kStore); };
        request.onsuccess = () => { resolve(request.result); };
        request.onerror = () => { reject(request.error ?? new Error("IndexedDB")); };
    });
}

let base: Promise<IDBDatabase> | undefined;

/** What `act` asked for, when all of it is done. */
async function ask<T>(mode: IDBTransactionMode, act: (store: IDBObjectStore) => () => T): Promise<T> {
    const db = await (base ??= open());
    return new Promise<T>((resolve, reject) => {
        const transaction = db.transaction(kStore, mode, { durability: "strict" });
        const result = act(transaction.objectStore(kStore));
        transaction.oncomplete = () => { resolve(result()); };
        transaction.onabort = () => { reject(transaction.error ?? new Error("IndexedDB")); };
    });
}

/** All that is kept, the newest first. */
function entries(): Promise<Kept[]> {
    return ask("readonly", (store) => {
        const keys = store.getAllKeys(), values = store.getAll() as IDBRequest<unknown[]>;
        return () => {
            const all = new Map(keys.result.map((key, i) => [key as string, values.result[i]]));
            return [...all].flatMap(([key, text]) => (typeof text === "string" ? [{ key, text, time: Number(all.get(timeOf(key)) ?? 0) }] : [])).sort((a, b) => b.time - a.time);
        };
    });
}

const locks = (): LockManager | undefined => ("locks" in navigator ? navigator.locks : undefined);

/** Holds a key until the window is gone, unless another holds it. */
function held(key: string, patience?: number): Promise<boolean> {
    return new Promise((resolve) => {
        const until = patience === undefined ? { ifAvailable: true } : { signal: AbortSignal.timeout(patience) };
        const taken = locks()?.request(`freiform ${key}`, until, (lock) => {
            resolve(lock !== null);
            return lock ? new Promise<void>(() => undefined) : undefined;
        });
        if (taken) taken.catch(() => { resolve(false); });
        else resolve(patience !== undefined);
    });
}

/** The key of this window, and what is kept there. */
async function claim(): Promise<{ readonly key: string; text: string | undefined }> {
    const all = await entries(), own = sessionStorage.getItem(kWindow);
    if (!locks()) await ask("readwrite", (store) => { for (const { key } of all.slice(kMost)) for (const k of [key, timeOf(key)]) store.delete(k); return () => undefined; });
    const textOf = (key: string): string | undefined => (all.find((it) => it.key === key) ?? all[0])?.text;
    if (own !== null && (await held(own, kPatience))) return { key: own, text: textOf(own) };
    for (const key of [...all.map((it) => it.key), kFirst, `${Date.now()} ${Math.random()}`]) {
        if (!(await held(key))) continue;
        sessionStorage.setItem(kWindow, key);
        return { key, text: textOf(key) };
    }
    throw new Error("a new key is free");
}

let claimed: ReturnType<typeof claim> | undefined;
const mine = (): ReturnType<typeof claim> => (claimed ??= claim());

export async function keep(text: string): Promise<void> {
    const own = await mine(), { key } = own;
    own.text = text;
    await ask("readwrite", (store) => { store.put(text, key); store.put(Date.now(), timeOf(key)); return () => undefined; });
}

/** What this window kept, or what it begins with. */
export const kept = async (): Promise<string | undefined> => (await mine()).text;
