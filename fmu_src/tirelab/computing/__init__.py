"""How work is spread over a machine: threads of the linear algebra, processes, a cluster."""
