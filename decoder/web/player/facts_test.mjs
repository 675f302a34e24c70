// Run by player_test.py: formats of numbers on the page.
import assert from "node:assert/strict";
import { test } from "node:test";

import { digits, sizeText, timeText, roundedUp } from "./facts.js";

function testEach(name, of, pairs) {
  test(name, () => {
    for (const [value, expected] of pairs) assert.equal(of(value), expected);
  });
}

testEach("NumbersHaveThreeDigitsThatCount", digits,
  [[0, "0"], [20, "20"], [123, "123"], [12345, "12300"], [0.0012344, "0.00123"], [0.5, "0.5"]]);

testEach("SizesAreRoundedBeforeTheirUnitIsChosen", sizeText, [
  [0, "0 B"], [1, "1 B"], [999, "999 B"], [1000, "1 kB"], [1234, "1.23 kB"], [999499, "999 kB"],
  [999600, "1 MB"], [999.6e6, "1 GB"], [12e9, "12 GB"], [999.6e9, "1 TB"], [5e15, "5000 TB"],
]);

testEach("TimesHaveTwoDigitsOrNoFraction", timeText,
  [[0.123, "0.12 ms"], [9.96, "10 ms"], [123.4, "123 ms"]]);

testEach("ScalesEndAtTheSmallestRoundNumberThatIsEnough", (value) => digits(roundedUp(value)), [
  [0, "0"], [1, "1"], [1.1, "2"], [2, "2"], [4.9, "5"], [7, "10"], [12, "20"], [123, "200"],
  [0.03, "0.05"], [0.3, "0.5"], [1e-4, "0.0001"],
]);
