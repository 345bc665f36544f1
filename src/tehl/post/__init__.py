"""What a result implies: profiles and balances, computed after the solve."""
