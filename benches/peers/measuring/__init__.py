"""What the comparisons have in common: programs that stay alive, figures from rounds, and facts about the machine."""
