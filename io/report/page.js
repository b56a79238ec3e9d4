"use strict";
// What every page has, whatever is on it: dark or light, and the list of its sections.
(() => {
  const root = document.documentElement, dark = matchMedia("(prefers-color-scheme: dark)"), name = "tumble-theme";
  // A page from disk or in a sandbox may be refused its storage: then a choice lasts as long as the page.
  const stored = use => { try { return use(localStorage); } catch { return null; } };
  let chosen = stored(storage => storage.getItem(name));
  const theme = () => chosen == "dark" || chosen == "light" ? chosen : dark.matches ? "dark" : "light";
  const show = as => {
    if (root.dataset.theme == as) return;
    root.dataset.theme = as;
    document.getElementById("theme")?.setAttribute("aria-pressed", as == "dark");
    dispatchEvent(new Event("themechange"));
  };
  show(theme());
  dark.addEventListener("change", () => show(theme()));
  addEventListener("beforeprint", () => show("light"));
  addEventListener("afterprint", () => show(theme()));

  addEventListener("DOMContentLoaded", () => {
    const button = document.getElementById("theme");
    button.setAttribute("aria-pressed", theme() == "dark");
    button.addEventListener("click", () => {
      chosen = theme() == "dark" ? "light" : "dark";
      stored(storage => storage.setItem(name, chosen));
      show(chosen);
    });
    const heads = [...document.querySelectorAll("main section:not([hidden], .caveats) > h2")];
    const contents = document.getElementById("contents");
    if (heads.length < 3) return contents.remove();
    heads.forEach((head, i) => {
      head.id ||= `section-${i + 1}`;
      const link = document.createElement("a");
      link.href = "#" + head.id;
      link.textContent = head.textContent;
      contents.append(link);
    });
  });
})();
