#pragma once

#include <string>

namespace coplane
{
/// A field of a table by RFC 4180: in quotes when it has a comma, a quote or a new line.
std::string csvField(const std::string& text);

/// A word of a command line: in single quotes where the shell would take it apart.
std::string shellWord(const std::string& text);

/// Text for an attribute in double quotes or for the content of an XML element. What XML 1.0 cannot
/// hold becomes U+FFFD.
std::string xmlText(const std::string& text);

/// Whether the bytes are UTF-8, without surrogates and overlong forms.
bool isUtf8(const std::string& bytes);

/// The text itself when it is UTF-8, else its bytes taken as Latin-1.
std::string asUtf8(const std::string& bytes);

/// Any bytes as UTF-8, one character for each, and back.
std::string latin1AsUtf8(const std::string& bytes);
std::string utf8AsLatin1(const std::string& text);
} // namespace coplane
