// What is being edited outlives a crash of the browser: every settled state goes into IndexedDB, the newest wins.

const kBase = "freiform", kStore = "documents", kKey = "now";

function open(): Promise<IDBDatabase> {
    return new Promise((resolve, reject) => {
        const request = indexedDB.open(kBase, 1);
        request.onupgradeneeded = () => { request.result.createObjectStore(kStore); };
        request.onsuccess = () => { resolve(request.result); };
        request.onerror = () => { reject(request.error ?? new Error("IndexedDB")); };
    });
}

let base: Promise<IDBDatabase> | undefined;

function ask<T>(mode: IDBTransactionMode, act: (store: IDBObjectStore) => IDBRequest<T>): Promise<T> {
    base ??= open();
    return base.then((db) => new Promise<T>((resolve, reject) => {
        const request = act(db.transaction(kStore, mode, { durability: "strict" }).objectStore(kStore));
        request.onsuccess = () => { resolve(request.result); };
        request.onerror = () => { reject(request.error ?? new Error("IndexedDB")); };
    }));
}

export const keep = (text: string): Promise<unknown> => ask("readwrite", (store) => store.put(text, kKey));
export const kept = (): Promise<string | undefined> => ask("readonly", (store) => store.get(kKey) as IDBRequest<string | undefined>);
