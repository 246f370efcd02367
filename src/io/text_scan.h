// Reading numbers and words out of text in memory, without copies and independent of the locale.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rangepose {

/// Takes the next word (no white space in it) off the front of `rest`; empty at the end.
std::string_view takeWord(std::string_view& rest);

/// Takes the next line off the front of `rest`, without its line end (\n or \r\n).
std::string_view takeLine(std::string_view& rest);

std::vector<std::string> wordsOf(std::string_view line);

/// The number that the whole word is; nan and inf in any case are numbers.
std::optional<double> parseNumber(std::string_view word);

/// The whole number that the word is, from 0 to 2^63 - 1.
std::optional<long long> parseCount(std::string_view word);

}  // namespace rangepose
