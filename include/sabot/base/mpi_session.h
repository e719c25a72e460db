#ifndef sabot_base_mpi_session_h
#define sabot_base_mpi_session_h

#include <memory>

namespace sabot
{
/**
 * MPI, and the libraries that deal.II starts with it, from construction to
 * destruction; one thread a rank. One object in main(), before anything
 * collective. Keeps deal.II's header (3.5 s of parsing) out of programs.
 */
class MpiSession
{
public:
  /** Takes MPI's own arguments out of @p argc and @p argv. Collective. */
  MpiSession(int &argc, char **&argv);
  /** Collective; during the unwinding of an exception MPI aborts instead. */
  ~MpiSession();
  MpiSession(const MpiSession &) = delete;
  MpiSession &operator=(const MpiSession &) = delete;

  /** Number of this process among all, from 0. */
  int rank() const;
  int n_ranks() const;

private:
  struct Libraries;
  std::unique_ptr<Libraries> libraries;
};
} // namespace sabot

#endif
