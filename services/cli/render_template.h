// Templates over summary.json.
#pragma once

#include <filesystem>
#include <string>

namespace dispersa {

/// The text of a Jinja template over a summary.json, by Debian's python3-jinja2, in its sandbox: a template
/// reads values and nothing else. InputError with file and line when the template is bad, cannot be read, or
/// there is no jinja2.
std::string RenderTemplate(const std::filesystem::path& summary, const std::filesystem::path& template_file);

}  // namespace dispersa
