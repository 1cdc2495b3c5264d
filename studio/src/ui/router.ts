// Where the reader is stands in the address behind the #: #/explore/R5, #/edit, #/inspect.

export interface Place { readonly view: "explore" | "edit" | "inspect"; readonly page: string }

export function parse(hash: string): Place {
    const [view = "", page = ""] = hash.replace(/^#\/?/, "").split("/");
    if (view === "edit" || view === "inspect") return { view, page: "" };
    return { view: "explore", page: /^R\d+$/.test(page) ? page : "" };
}

export const address = (place: Place): string => `#/${place.view}${place.page === "" ? "" : `/${place.page}`}`;

export function go(place: Place): void {
    location.hash = address(place);
}
