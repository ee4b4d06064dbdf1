"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const $ = (selector) => document.querySelector(selector);
const make = (name, text, parent) => { const e = document.createElement(name); e.textContent = text; parent.append(e); return e; };
const number = (x, digits = 3) => Number(x).toLocaleString("en", {maximumSignificantDigits: digits});
