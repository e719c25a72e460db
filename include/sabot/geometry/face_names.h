#ifndef sabot_geometry_face_names_h
#define sabot_geometry_face_names_h

#include <string>
#include <vector>

namespace sabot
{
/** From words to boundary ids. Numbers of the faces that @p text lists,
   separated by commas, among the @p allowed ones, which are numbered in order.
   Throws InputError for the entry @p path with the list of allowed names for
   any other. */
std::vector<unsigned int> face_ids(const std::string &path,
                                   const std::string &text,
                                   const std::vector<std::string> &allowed);
/** The same of axes, or other words; @p what: one of them, in the message. */
std::vector<unsigned int> word_ids(const std::string &path,
                                   const std::string &text,
                                   const std::vector<std::string> &allowed,
                                   const std::string &what);
} // namespace sabot

#endif
