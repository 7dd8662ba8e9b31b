#include "services/worker/program.h"

int main(int argc, char** argv) { return dispersa::RunWorker(argc, argv); }
