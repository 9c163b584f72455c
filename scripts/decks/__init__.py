"""Generated CalculiX decks with contact, from which compare_speed.py takes its rows: ten families, by size and seed."""
